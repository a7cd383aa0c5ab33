#include "filters/shape/denoise_threshold.h"

#include "base/median.h"
#include "base/reduce.h"
#include "filters/shape/denoise_threshold_risk.h"
#include "schemes/sure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace multires {
namespace {

struct Counter {
    Index zeroed = 0, all = 0;
    Counter& operator+=(const Counter& o) {
        zeroed += o.zeroed, all += o.all;
        return *this;
    }
    double share() const { return all > 0 ? static_cast<double>(zeroed) / all : 0; }
};

/// By level and subband, mesh units; only those of the levels that are chosen count.
using Thresholds = std::vector<std::vector<double>>;

/// Shrinks the details of one pyramid.
class Thresholding {
public:
    /// @param directions   positions that the normals are those of
    /// @param normal_only  only the parts along the normals are shrunk
    Thresholding(const Pyramid& pyramid, const Positions& directions, const DenoiseOptions& options, bool normal_only)
        : pyramid_(pyramid), directions_(directions), options_(options), normal_only_(normal_only) {}

    Shrink rule() const { return options_.method == DenoiseMethod::hard_threshold ? Shrink::hard : Shrink::soft; }
    int first() const { return options_.finest_level; }
    int last(const Coefficients& c) const {
        return std::min(options_.coarsest_level, static_cast<int>(c.level.size()));
    }

    /// Those of least risk for noise of this deviation in each component, subband by subband or for all of them that of
    /// the finest.
    Thresholds by_risk(const Coefficients& c, double deviation) const {
        const NoiseGains gains = noise_gains(pyramid_.hierarchy(), pyramid_.scheme());
        Thresholds t(c.level.size());
        for (int k = first(); k < last(c); ++k)
            for (std::size_t b = 0; b < c.level[k].size(); ++b) {
                const bool same = !options_.per_level && (k > first() || b > 0);
                t[k].push_back(same ? t[first()][0]
                                    : sure_threshold(lengths(c.level[k][b]), normal_only_ ? 1 : 3,
                                                     deviation * gains[k][b], rule()));
            }
        return t;
    }

    /// The length that a share of the details of all subbands chosen do not exceed.
    double of_share(const Coefficients& c, double share) const {
        std::vector<double> all;
        for (int k = first(); k < last(c); ++k)
            for (const Subband& band : c.level[k]) {
                const std::vector<double> more = lengths(band);
                all.insert(all.end(), more.begin(), more.end());
            }
        return share > 0 && !all.empty() ? lower_quantile(all, share) : 0;
    }

    struct Shrunk {
        Positions positions;
        std::vector<double> share_zeroed;  ///< of the levels that are chosen
    };
    /// @param confidence  see by_threshold()
    Shrunk shrunk(Coefficients c, const Thresholds& thresholds, double factor,
                  const std::vector<double>& confidence) const {
        Shrunk out;
        for (int k = first(); k < last(c); ++k) {
            Counter counter;
            for (std::size_t b = 0; b < c.level[k].size(); ++b)
                counter += shrink_subband(c.level[k][b], factor * thresholds[k][b], confidence);
            out.share_zeroed.push_back(counter.share());
        }
        out.positions = positions_in_input(pyramid_.hierarchy(), pyramid_.scheme().synthesise(c));
        return out;
    }

private:
    double along(const Vec3& axis, const double* d) const {
        return axis.x() * d[0] + axis.y() * d[1] + axis.z() * d[2];
    }
    Vec3 normal(const Subband& band, Index r) const { return pyramid_.scheme().normal(band, r, directions_); }

    std::vector<double> lengths(const Subband& band) const {
        std::vector<double> out(band.rows());
        parallel_for(band.rows(), [&](Index r) {
            const double* d = band.values.row(r);
            out[r] =
                normal_only_ ? std::abs(along(normal(band, r), d)) : std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        });
        return out;
    }

    Counter shrink_subband(Subband& band, double threshold, const std::vector<double>& confidence) const {
        return chunked_fold<Counter>(band.rows(), [&](Counter& counter, std::size_t row) {
            const Index r = static_cast<Index>(row);
            double t = threshold;
            if (!confidence.empty()) t *= 1 - confidence[pyramid_.hierarchy().order[band.place(r)]];
            double* d = band.values.row(r);
            if (normal_only_) {
                const Vec3 axis = normal(band, r);
                double length = along(axis, d);
                const double before = length;
                counter.zeroed += shrink(&length, 1, t, rule());
                for (int c = 0; c < 3; ++c) d[c] += (length - before) * axis[c];
            } else {
                counter.zeroed += shrink(d, 3, t, rule());
            }
            ++counter.all;
        });
    }

    const Pyramid& pyramid_;
    const Positions& directions_;
    const DenoiseOptions& options_;
    bool normal_only_;
};

/// What was done on one hierarchy.
struct Outcome {
    Positions positions;
    std::vector<double> thresholds, share_zeroed;  ///< by level chosen, of the first subband
};

void tell_thresholds(const Thresholds& t, double factor, const Thresholding& thresholding, int last, Outcome& out) {
    for (int k = thresholding.first(); k < last; ++k) out.thresholds.push_back(factor * t[k].front());
}

/// The same threshold everywhere, of the pyramid's own details, in their frames.
Outcome with_given(const Pyramid& pyramid, const Positions& positions, const DenoiseOptions& options, double given,
                   const std::vector<double>& confidence) {
    Coefficients c = pyramid.coefficients();
    for (std::vector<Subband>& level : c.level)
        for (Subband& band : level) widen(band);
    const Thresholding thresholding(pyramid, positions, options, options.normal_only);
    const double threshold = options.unit == ThresholdUnit::share ? thresholding.of_share(c, given / 100) : given;
    Thresholds t;
    for (const std::vector<Subband>& level : c.level) t.emplace_back(level.size(), threshold);
    Outcome out;
    tell_thresholds(t, 1, thresholding, thresholding.last(c), out);
    Thresholding::Shrunk shrunk = thresholding.shrunk(std::move(c), t, 1, confidence);
    out.positions = std::move(shrunk.positions);
    out.share_zeroed = std::move(shrunk.share_zeroed);
    return out;
}

/// Positions as functions on the surface, without frames, so that what noise makes of the details is known.
Coefficients details_of(const Pyramid& pyramid, const Positions& p) {
    Field f = field_of(p);
    f.has_positions = false;
    return pyramid.scheme().analyse(to_places(pyramid.hierarchy(), f));
}

/// What is done with thresholds.
struct Choice {
    double factor = 0;  ///< for all of them
    double share = 0;   ///< of the way from the input to the result
};

/// The choice with the least risk; zeros if none is clearly better than to do nothing.
Choice least_risk_choice(const Thresholding& thresholding, const Coefficients& c, const Coefficients& probed,
                         const Thresholds& thresholds, const NoisySurface& surface, double step,
                         const Progress& progress) {
    constexpr std::array<double, 6> factors = {2, 1.4, 1, 0.7, 0.5, 0.25};
    // The estimates are too good by a tenth now and then, and scatter on small meshes, those of the hard rule more.
    const double by_chance =
        (thresholding.rule() == Shrink::hard ? 6 : 3) / std::sqrt(static_cast<double>(surface.probe().size()));
    const double worth_edges = 0.9 - by_chance, worth_heights = 0.8 - by_chance;
    double best = worth_edges + worth_heights;
    Choice choice;
    for (const double& f : factors) {
        progress.report(static_cast<double>(&f - factors.data()) / factors.size(), "Choosing thresholds");
        const Positions after = thresholding.shrunk(c, thresholds, f, {}).positions;
        Positions response = thresholding.shrunk(probed, thresholds, f, {}).positions;
        for (std::size_t i = 0; i < after.size(); ++i) response[i] = (response[i] - after[i]) / step;
        const NoisySurface::Expected e = surface.expected(after, response);
        if (!(e.edges < worth_edges && e.heights < worth_heights && e.edges + e.heights < best)) continue;
        best = e.edges + e.heights;
        choice = {f, std::min(e.share, surface.nearest_share(after))};
    }
    return choice;
}

Outcome with_least_risk(const Pyramid& pyramid, const Positions& positions, const DenoiseOptions& options,
                        const NoisySurface& surface, const std::vector<double>& confidence, const Progress& progress) {
    constexpr double step = 0.5;  // of the noise: so large that the jumps of the hard rule are seen
    const bool normal_only = options.normal_only || !surface.all_directions();
    const Positions& directions = surface.deviation() > 0 ? surface.smooth() : positions;
    const Thresholding thresholding(pyramid, directions, options, normal_only);
    Outcome out;
    out.positions = positions;
    const int last = thresholding.last(pyramid.coefficients());
    out.share_zeroed.assign(std::max(0, last - thresholding.first()), 0);
    out.thresholds = out.share_zeroed;
    if (!(surface.deviation() > 0)) return out;

    const Coefficients c = details_of(pyramid, positions);
    Positions p = positions;
    for (std::size_t i = 0; i < p.size(); ++i) p[i] += step * surface.probe()[i];
    const Coefficients probed = details_of(pyramid, p);
    const Thresholds t = thresholding.by_risk(c, surface.deviation());
    const Choice choice = least_risk_choice(thresholding, c, probed, t, surface, step, progress);
    const double factor = options.strength * choice.factor;
    if (!(factor > 0 && choice.share > 0)) return out;
    out.thresholds.clear();
    tell_thresholds(t, factor, thresholding, last, out);
    Thresholding::Shrunk shrunk = thresholding.shrunk(c, t, factor, confidence);
    for (std::size_t i = 0; i < positions.size(); ++i)
        out.positions[i] += choice.share * (shrunk.positions[i] - positions[i]);
    out.share_zeroed = std::move(shrunk.share_zeroed);
    return out;
}

}  // namespace

Positions by_threshold(const Layer& layer, const DenoiseOptions& options, double given,
                       const std::vector<double>& confidence, Session& session, Report& report) {
    const Positions& positions = layer.mesh.positions;
    std::optional<NoisySurface> surface;
    if (options.unit == ThresholdUnit::automatic) surface.emplace(layer.mesh, session.progress.part(0, 0.2));
    const double deviation = surface ? surface->deviation() : noise_deviation(layer.mesh);
    report.add("noise", deviation, "mesh units");

    // What the pyramid is built by must not depend on the noise: the estimate of the risk takes it for given.
    Layer smooth;
    const bool noisy = surface && surface->deviation() > 0;
    if (noisy) {
        smooth = layer;
        smooth.mesh.positions = surface->smooth();
    }
    const Layer& shape = noisy ? smooth : layer;
    Positions mean(positions.size(), Vec3::Zero());
    for (int spin = 0; spin < options.cycle_spins; ++spin) {
        const double begin = 0.2 + 0.75 * spin / options.cycle_spins, share = 0.75 / options.cycle_spins;
        PyramidOptions o = options.pyramid;
        o.hierarchy.seed += spin;
        // The first hierarchy is the one that is kept; the others are different and thrown away.
        PyramidCache thrown_away;
        Report unused;
        const auto pyramid = pyramid_of(shape, o, spin == 0 ? session.pyramids : thrown_away,
                                        session.progress.part(begin, begin + 0.6 * share), spin == 0 ? report : unused);
        const Outcome out = surface ? with_least_risk(*pyramid, positions, options, *surface, confidence,
                                                      session.progress.part(begin + 0.6 * share, begin + share))
                                    : with_given(*pyramid, positions, options, given, confidence);
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += (out.positions[i] - mean[i]) / (spin + 1);
        if (spin > 0) continue;
        const NoiseGains gains = noise_gains(pyramid->hierarchy(), pyramid->scheme());
        std::vector<double> noise;
        for (std::size_t k = 0; k < out.thresholds.size(); ++k)
            noise.push_back(deviation * gains[options.finest_level + k].front());
        report.add("noise_per_level", noise, "mesh units");
        report.add("threshold_per_level", out.thresholds, "mesh units");
        report.add("share_zeroed", out.share_zeroed);
    }
    return mean;
}

}  // namespace multires
