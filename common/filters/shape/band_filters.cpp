#include "filters/shape/band_filters.h"

#include "base/parallel.h"
#include "measure/measure.h"
#include "measure/vertex_normals.h"
#include "mesh/adjacency.h"
#include "mesh/validation.h"
#include "pyramid/bodies.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

void require_finite(double value, const std::string& name) {
    if (!std::isfinite(value)) throw InputError(name + " must be a number");
}

/// The steps of every calibrated filter: start, solver, low passes, region, report.
template <class Options, class Limits>
Result filter_calibrated(const Layer& layer, const Options& options, Session& session, const Limits& limits) {
    Result result;
    const std::vector<double> weights = region_weights(layer, options.region);
    const Start start(layer, options.relative_to, session, result.report);
    const Mesh& mesh = start.layer().mesh;
    const std::vector<Limit> all = limits(start.layer(), result.report);
    const auto spline = spline_of(start.layer(), options.pyramid.features, session, result.report);
    Positions after = mesh.positions;
    const Progress progress = session.progress.part(0.3, options.calibration.measure ? 0.6 : 0.95);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double share = 1 / static_cast<double>(all.size()), begin = share * static_cast<double>(i);
        const Cutoff cutoff{options.calibration.order, all[i].wavelength};
        const Positions low = spline->low_pass(mesh, cutoff, all[i].parameter, progress.part(begin, begin + share));
        parallel_for(static_cast<Index>(after.size()), [&](Index v) {
            const Vec3 &p = mesh.positions[v], &q = low[v];
            if (all[i].step == 1 && all.size() == 1) {
                after[v] = q;
            } else if (p != q) {
                after[v] += all[i].step * (q - p);
            }
        });
    }
    report_transmission(*spline, mesh, options.calibration, all, session.progress.part(0.6, 0.95), result.report);
    const Drift way = drift(mesh.faces, mesh.positions, after);
    blend(layer.mesh.positions, weights, after);
    session.progress.report(0.97, "Measuring the change");
    result.report.add("normal_rms", way.normal_rms, "mesh units");
    result.report.add("tangential_rms", way.tangential_rms, "mesh units");
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    return result;
}

/// The steps shared by all band filters: start, pyramid, gains, synthesis, region, report.
template <class Options, class GainsOf>
Result filter_bands(const Layer& layer, const Options& options, Session& session, const GainsOf& gains_of) {
    Result result;
    const std::vector<double> weights = region_weights(layer, options.region);
    const Start start(layer, options.relative_to, session, result.report);
    const auto pyramid = pyramid_of(start.layer(), options.pyramid, session, result.report);
    const Bodies bodies(*pyramid, start.layer());
    const Gains gains = bodies.gains([&](const auto& levels) { return gains_of(start.layer(), levels); });
    session.progress.report(0.9, "Putting the levels together");
    Positions after = all_one(gains) ? start.layer().mesh.positions : bodies.synthesise(gains);
    blend(layer.mesh.positions, weights, after);
    session.progress.report(0.97, "Measuring the change");
    result.report.add("gains", gains[0]);
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    return result;
}

}  // namespace

Result low_pass(const Layer& layer, const LowPassOptions& options, Session& session) {
    require_usable(layer.mesh);  // before a default that could not be derived from the mesh is blamed
    Band band;
    band.unit = options.unit;
    band.softness = options.softness;
    require_finite(options.cutoff, "cutoff");
    if (!(options.cutoff > 0)) throw InputError("cutoff must be more than 0");
    const bool vertices = options.unit == Unit::vertices;
    band.finest = vertices ? 1e300 : 0;
    band.coarsest = options.cutoff;
    if (options.calibration.method == BandMethod::spline)
        return filter_calibrated(layer, options, session, [&](const Layer& start, Report& report) {
            return limits_of(start, band, 0, "cutoff", options.pyramid, session, report);
        });
    return filter_bands(layer, options, session, [&](const Layer& start, const std::vector<LevelInfo>& levels) {
        return band_gains(levels, band, box_diagonal(start), 0);
    });
}

Result scale_band(const Layer& layer, const BandOptions& options, Session& session) {
    require_finite(options.gain, "gain");
    if (options.calibration.method == BandMethod::spline)
        return filter_calibrated(layer, options, session, [&](const Layer& start, Report& report) {
            return limits_of(start, options.band, options.gain, "coarsest", options.pyramid, session, report);
        });
    return filter_bands(layer, options, session, [&](const Layer& start, const std::vector<LevelInfo>& levels) {
        return band_gains(levels, options.band, box_diagonal(start), options.gain);
    });
}

std::array<double, equalizer_bands + 1> equalizer_limits(const Layer& layer, const PyramidOptions& options) {
    const double finest = 2 * mean_edge_length(layer.mesh.faces, layer.mesh.positions);
    const double vertices = static_cast<double>(layer.mesh.positions.size());
    const double ratio = std::sqrt(std::max(2.0, vertices / options.hierarchy.base_vertices));
    std::array<double, equalizer_bands + 1> limit{};
    for (int i = 0; i <= equalizer_bands; ++i)
        limit[i] = finest * std::pow(ratio, static_cast<double>(i) / equalizer_bands);
    return limit;
}

Result equalizer(const Layer& layer, const EqualizerOptions& options, Session& session) {
    for (int i = 0; i < equalizer_bands; ++i) require_finite(options.gain[i], "gain_" + std::to_string(i + 1));
    if (options.calibration.method == BandMethod::spline)
        return filter_calibrated(layer, options, session, [&](const Layer& start, Report&) {
            const auto limit = equalizer_limits(start, options.pyramid);
            std::vector<Limit> limits;
            for (int i = 1; i <= equalizer_bands; ++i) {
                const double coarser = i < equalizer_bands ? options.gain[i] : 1;
                if (coarser != options.gain[i - 1])
                    limits.push_back({limit[i], coarser - options.gain[i - 1], "gains"});
            }
            return limits;
        });
    return filter_bands(layer, options, session, [&](const Layer& start, const std::vector<LevelInfo>& levels) {
        const auto limit = equalizer_limits(start, options.pyramid);
        std::vector<double> gains(levels.size() - 1, 1);
        for (int i = 0; i < equalizer_bands; ++i) {
            if (options.gain[i] == 1) continue;
            Band band;
            band.softness = options.softness;
            band.finest = i == 0 ? 0 : limit[i];
            band.coarsest = i == equalizer_bands - 1 ? 1e300 : limit[i + 1];
            const std::vector<double> share = band_share(levels, band, 0);
            for (std::size_t k = 0; k < gains.size(); ++k) gains[k] += share[k] * (options.gain[i] - 1);
        }
        return gains;
    });
}

Result detail_quality(const Layer& layer, const DetailOptions& options, Session& session) {
    Result result;
    const auto pyramid = pyramid_of(layer, options.pyramid, session, result.report);
    const Bodies bodies(*pyramid, layer);
    const Gains gains = band_gains(bodies, options.band, box_diagonal(layer), 0);
    session.progress.report(0.9, "Measuring the details");
    const Positions without = bodies.synthesise(gains);
    const Array<Vec3> normal =
        options.signed_normal ? vertex_normals(layer.mesh.faces, layer.mesh.positions) : Array<Vec3>();
    std::vector<double> detail(without.size());
    for (std::size_t i = 0; i < detail.size(); ++i) {
        const Vec3 d = layer.mesh.positions[i] - without[i];
        detail[i] = options.signed_normal ? normal[i].dot(d) : d.norm();
    }
    const auto [least, most] = std::minmax_element(detail.begin(), detail.end());
    result.report.add("gains", gains[0]);
    result.report.add("least_detail", *least, "mesh units");
    result.report.add("largest_detail", *most, "mesh units");
    result.report.add("rms_detail", rms(detail), "mesh units");
    result.quality = std::move(detail);
    return result;
}

Result unsharp(const Layer& layer, const UnsharpOptions& options, Session& session) {
    Result result;
    const Start start(layer, options.relative_to, session, result.report);
    const Mesh& mesh = start.layer().mesh;
    require_usable(mesh);
    require_finite(options.xi, "xi");
    require(options.iterations >= 1, "iterations must be at least 1");
    const std::vector<double> weights = region_weights(layer, options.region);
    session.progress.report(0, "Computing weights");
    Rings rings = surface_rings(mesh);
    mark_features(rings, start.layer(), options.features, options.feature_angle);
    if (uses_flaps(options.op)) find_flaps(rings);
    RelaxationOptions relaxation_options;
    relaxation_options.op = options.op;
    const RingWeights rows = ring_weights(rings, mesh.positions, relaxation_options);
    const Array<double> step = stable_steps(rings, rows);
    Positions smooth = mesh.positions, next = smooth;
    for (int i = 0; i < options.iterations; ++i) {
        session.progress.report(0.2 + 0.7 * i / options.iterations, "Relaxing");
        relax(rings, rows, smooth, next);
        parallel_for(rings.rows(), [&](Index r) {
            const Index v = rings.vertex(r);
            if (step[r] < 1) next[v] = smooth[v] + step[r] * (next[v] - smooth[v]);
        });
        smooth.swap(next);
    }
    session.progress.report(0.9, "Measuring the change");
    Positions after = mesh.positions;
    if (options.xi != 1)
        for (std::size_t i = 0; i < after.size(); ++i) after[i] = smooth[i] + options.xi * (after[i] - smooth[i]);
    blend(layer.mesh.positions, weights, after);
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    return result;
}

}  // namespace multires
