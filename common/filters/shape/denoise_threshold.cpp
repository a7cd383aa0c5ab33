#include "filters/shape/denoise_threshold.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

struct Counter {
    Index zeroed = 0, all = 0;
};

class Thresholding {
public:
    Thresholding(const Pyramid& pyramid, const Positions& positions, const DenoiseOptions& options, double given,
                 double deviation, const std::vector<double>& confidence)
        : pyramid_(pyramid), positions_(positions), options_(options), given_(given), deviation_(deviation),
          confidence_(confidence), gains_(noise_gains(pyramid.hierarchy(), pyramid.scheme())),
          coefficients_(pyramid.coefficients()) {
        for (std::vector<Subband>& level : coefficients_.level)
            for (Subband& band : level) widen(band);
    }

    Positions run() {
        const int last = std::min(options_.coarsest_level, static_cast<int>(coefficients_.level.size()));
        for (int k = options_.finest_level; k < last; ++k) {
            Counter counter;
            thresholds.push_back(level_threshold(k));
            noise.push_back(deviation_ * gains_[k].front());
            for (std::size_t b = 0; b < coefficients_.level[k].size(); ++b)
                shrink_subband(coefficients_.level[k][b], band_threshold(k, b), counter);
            share_zeroed.push_back(counter.all ? static_cast<double>(counter.zeroed) / counter.all : 0);
        }
        return positions_in_input(pyramid_.hierarchy(), pyramid_.scheme().synthesise(coefficients_));
    }

    std::vector<double> thresholds, noise, share_zeroed;

private:
    /// Of the first subband. Automatic: three deviations of the noise in a component, where a plane's details are
    /// almost all below.
    double level_threshold(int level) const {
        if (options_.unit != ThresholdUnit::automatic) return given_;
        const int k = options_.per_level ? level : options_.finest_level;
        return 3 * options_.strength * deviation_ * gains_[k].front();
    }

    /// Automatic and per level: of the other subbands in proportion to the noise they take up.
    double band_threshold(int level, std::size_t band) const {
        const double first = level_threshold(level);
        if (band == 0 || options_.unit != ThresholdUnit::automatic || !options_.per_level) return first;
        const std::vector<double>& gain = gains_[level];
        return gain[0] > 0 ? first * gain[band] / gain[0] : first;
    }

    void shrink_subband(Subband& band, double threshold, Counter& counter) const {
        const Shrink rule = options_.method == DenoiseMethod::hard_threshold ? Shrink::hard : Shrink::soft;
        for (Index r = 0; r < band.rows(); ++r) {
            double t = threshold;
            if (!confidence_.empty()) t *= 1 - confidence_[pyramid_.hierarchy().order[band.place(r)]];
            double* d = band.values.row(r);
            bool zeroed;
            if (options_.normal_only) {
                const Vec3 axis = pyramid_.scheme().normal(band, r, positions_);
                double along = axis.x() * d[0] + axis.y() * d[1] + axis.z() * d[2];
                const double before = along;
                zeroed = shrink(&along, 1, t, rule);
                for (int c = 0; c < 3; ++c) d[c] += (along - before) * axis[c];
            } else {
                zeroed = shrink(d, 3, t, rule);
            }
            counter.zeroed += zeroed;
            ++counter.all;
        }
    }

    const Pyramid& pyramid_;
    const Positions& positions_;
    const DenoiseOptions& options_;
    double given_, deviation_;
    const std::vector<double>& confidence_;
    NoiseGains gains_;
    Coefficients coefficients_;
};

}  // namespace

Positions by_threshold(const Layer& layer, const DenoiseOptions& options, double given, double deviation,
                       const std::vector<double>& confidence, Session& session, Report& report) {
    Positions mean(layer.mesh.positions.size(), Vec3::Zero());
    for (int spin = 0; spin < options.cycle_spins; ++spin) {
        PyramidOptions o = options.pyramid;
        o.hierarchy.seed += spin;
        // The first hierarchy is the one that is kept; the others are different and thrown away.
        PyramidCache thrown_away;
        Report unused;
        const auto pyramid = pyramid_of(
            layer, o, spin == 0 ? session.pyramids : thrown_away,
            session.progress.part(static_cast<double>(spin) / options.cycle_spins, (spin + 1.0) / options.cycle_spins),
            spin == 0 ? report : unused);
        Thresholding thresholding(*pyramid, layer.mesh.positions, options, given, deviation, confidence);
        const Positions p = thresholding.run();
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += (p[i] - mean[i]) / (spin + 1);
        if (spin > 0) continue;
        report.add("noise_per_level", thresholding.noise, "mesh units");
        report.add("threshold_per_level", thresholding.thresholds, "mesh units");
        report.add("share_zeroed", thresholding.share_zeroed);
    }
    return mean;
}

}  // namespace multires
