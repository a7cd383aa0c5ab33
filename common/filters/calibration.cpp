#include "filters/calibration.h"

#include "base/number.h"
#include "measure/measure.h"
#include "mesh/adjacency.h"
#include "mesh/validation.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// The ends of the feature edges.
std::vector<std::uint8_t> held_vertices(const Layer& layer, const FeatureOptions& features) {
    if (features.from == Features::none) return {};
    Rings rings = surface_rings(layer.mesh);
    mark_features(rings, layer, features.from, features.angle);
    std::vector<std::uint8_t> held(layer.mesh.positions.size(), 0);
    bool any = false;
    for (std::size_t i = 0; i < rings.feature.size(); ++i)
        if (rings.feature[i]) held[rings.neighbor[i]] = 1, any = true;
    return any ? held : std::vector<std::uint8_t>();
}

}  // namespace

BandMethod default_method(const Mesh& mesh) {
    constexpr double most_spread = 1.6;
    return edge_spread(mesh.faces, mesh.positions) > most_spread ? BandMethod::spline : BandMethod::pyramid;
}

std::vector<Limit> limits_of(const Layer& layer, const Band& band, double gain, const char* coarsest,
                             const PyramidOptions& options, Session& session, Report& report) {
    const double diagonal = box_diagonal(layer);
    check(band, diagonal);
    if (gain == 1) return {};
    std::vector<Limit> limits;
    const auto add = [&](double finest, double coarse) {
        if (finest > 0) limits.push_back({finest, gain - 1, "finest"});
        limits.push_back({coarse, 1 - gain, coarsest});
    };
    const double percent = diagonal / 100;
    switch (band.unit) {
    case Unit::wavelength:
        add(band.finest, band.coarsest);
        break;
    case Unit::wavelength_percent:
        add(band.finest * percent, band.coarsest * percent);
        break;
    case Unit::level:
    case Unit::vertices: {
        const auto pyramid = pyramid_of(layer, options, session, report);
        const bool all = band.unit == Unit::level ? band.finest <= 0 : band.finest >= pyramid->levels()[0].vertices;
        add(all ? 0 : wavelength_of(*pyramid, band.unit, band.finest),
            wavelength_of(*pyramid, band.unit, band.coarsest));
        break;
    }
    }
    return limits;
}

std::shared_ptr<const Spline> spline_of(const Layer& layer, const FeatureOptions& features, Session& session,
                                        Report& report) {
    require_usable(layer.mesh);
    const std::vector<std::uint8_t> held = held_vertices(layer, features);
    const bool reused = session.spline && session.spline->hash() == spline_hash(layer.mesh, held);
    if (!reused) session.spline = std::make_shared<const Spline>(layer.mesh, held, session.progress.part(0, 0.3));
    report.add("solver_reused", reused);
    return session.spline;
}

void report_transmission(const Spline& spline, const Mesh& mesh, const Calibration& calibration,
                         const std::vector<Limit>& limits, const Progress& progress, Report& report) {
    if (!calibration.measure || limits.empty()) return;
    double cutoff = 0;
    for (const Limit& limit : limits) cutoff = std::max(cutoff, limit.wavelength);
    const double step = std::sqrt(2.0);
    const auto all = measure_transmission(spline, mesh, {calibration.order, cutoff},
                                          {cutoff / step, cutoff, cutoff * step}, progress);
    std::vector<double> wave, measured, formula;
    for (const MeasuredTransmission& m : all) {
        wave.push_back(m.wave), measured.push_back(m.measured), formula.push_back(m.formula);
        report.say("Measured on this mesh: the low pass at " + number(cutoff, 3) + " leaves " + number(m.measured, 3) +
                   " of waves of " + number(m.wave, 3) + " (formula: " + number(m.formula, 3) + ").");
    }
    if (all.empty()) report.say("No part of the mesh is flat enough to measure the transmission.");
    report.add("measured_waves", wave, "mesh units");
    report.add("measured_transmission", measured);
    report.add("formula_transmission", formula);
}

}  // namespace multires
