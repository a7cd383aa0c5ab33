#include "filters/shape/denoise_threshold.h"

#include "schemes/frame.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// Details of one level and kind (odd or even), with what is needed to shrink them.
struct Part {
    Field& detail;
    const Rings& rings;
    double gain;  ///< of unit noise
};

struct Counter {
    Index zeroed = 0, all = 0;
};

/// Where a detail vector has its normal part: the third axis of local frames, or the surface's normal in world axes.
Vec3 normal_axis(const Hierarchy& h, const Positions& positions, const Rings& rings, Index row, bool local) {
    if (local) return {0, 0, 1};
    return ring_frame(rings.begin(row), rings.size(row), [&](Index v) { return positions[h.order[v]]; }).n;
}

class Thresholding {
public:
    Thresholding(const KeptPyramid& pyramid, const Positions& positions, const DenoiseOptions& options, double given,
                 double deviation, const std::vector<double>& confidence)
        : h_(pyramid.hierarchy()), positions_(positions), options_(options), given_(given), deviation_(deviation),
          confidence_(confidence), gains_(noise_gains(h_, pyramid.transform())), coefficients_(pyramid.coefficients()),
          local_(options.pyramid.scheme == Scheme::guskov) {
        for (Coefficients::Detail& d : coefficients_.detail) d = widened(d, 3);
    }

    Positions run(const KeptPyramid& pyramid) {
        const int last = std::min(options_.coarsest_level, static_cast<int>(coefficients_.detail.size()));
        for (int k = options_.finest_level; k < last; ++k) {
            Counter counter;
            const double threshold = level_threshold(k);
            thresholds.push_back(threshold);
            noise.push_back(deviation_ * gains_[k].odd);
            shrink_part({coefficients_.detail[k].odd, h_.levels[k].odd, gains_[k].odd}, threshold, counter);
            shrink_part({coefficients_.detail[k].even, h_.levels[k].even, gains_[k].even}, even_threshold(k, threshold),
                        counter);
            share_zeroed.push_back(counter.all ? static_cast<double>(counter.zeroed) / counter.all : 0);
        }
        return positions_in_input(h_, pyramid.transform().synthesise(coefficients_));
    }

    std::vector<double> thresholds, noise, share_zeroed;

private:
    /// Automatic: three deviations of the noise in a component, where a plane's details are almost all below.
    double level_threshold(int level) const {
        if (options_.unit != ThresholdUnit::automatic) return given_;
        const int k = options_.per_level ? level : options_.finest_level;
        return 3 * options_.strength * deviation_ * gains_[k].odd;
    }

    double even_threshold(int level, double odd) const {
        if (options_.unit != ThresholdUnit::automatic || !options_.per_level) return odd;
        return gains_[level].odd > 0 ? odd * gains_[level].even / gains_[level].odd : odd;
    }

    void shrink_part(const Part& part, double threshold, Counter& counter) const {
        const Shrink rule = options_.method == DenoiseMethod::hard_threshold ? Shrink::hard : Shrink::soft;
        for (Index r = 0; r < part.detail.rows(); ++r) {
            double t = threshold;
            if (!confidence_.empty()) t *= 1 - confidence_[h_.order[part.rings.vertex(r)]];
            double* d = part.detail.row(r);
            bool zeroed;
            if (options_.normal_only) {
                const Vec3 axis = normal_axis(h_, positions_, part.rings, r, local_);
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

    const Hierarchy& h_;
    const Positions& positions_;
    const DenoiseOptions& options_;
    double given_, deviation_;
    const std::vector<double>& confidence_;
    std::vector<NoiseGain> gains_;
    Coefficients coefficients_;
    bool local_;
};

}  // namespace

Positions by_threshold(const Layer& layer, const DenoiseOptions& options, double given, double deviation,
                       const std::vector<double>& confidence, Session& session, Report& report) {
    Positions mean(layer.mesh.positions.size(), Vec3::Zero());
    for (int spin = 0; spin < options.cycle_spins; ++spin) {
        PyramidOptions o = options.pyramid;
        o.seed = options.pyramid.seed + spin;
        // The first hierarchy is the one that is kept; the others are different and thrown away.
        Session part;
        part.progress =
            session.progress.part(static_cast<double>(spin) / options.cycle_spins, (spin + 1.0) / options.cycle_spins);
        if (spin == 0) part.pyramid = session.pyramid;
        Report unused;
        const auto pyramid = pyramid_of(layer, o, part, spin == 0 ? report : unused);
        if (spin == 0) session.pyramid = pyramid;
        Thresholding thresholding(*pyramid, layer.mesh.positions, options, given, deviation, confidence);
        const Positions p = thresholding.run(*pyramid);
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += (p[i] - mean[i]) / (spin + 1);
        if (spin > 0) continue;
        report.add("noise_per_level", thresholding.noise, "mesh units");
        report.add("threshold_per_level", thresholding.thresholds, "mesh units");
        report.add("share_zeroed", thresholding.share_zeroed);
    }
    return mean;
}

}  // namespace multires
