#include "filters/shape/watermark.h"

#include "measure/measure.h"
#include "measure/triangles.h"
#include "mesh/validation.h"
#include "watermark/carriers.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

std::vector<double> coefficients(const WatermarkOptions& options) {
    const CodeWord word = encoded(message_of(options.message, "message"));
    const Assignment key = assignment(options.key);
    std::vector<double> value(Carriers::most);
    for (Index c = 0; c < Carriers::most; ++c) value[c] = key.sign[c] * word[key.bit[c]];
    return value;
}

/// The larger of the RMS over the vertices in faces and that over the surface.
double rms_of(const std::vector<double>& area, const Array<Vec3>& field) {
    double squares = 0, count = 0, integral = 0, whole = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (!(area[i] > 0)) continue;
        squares += field[i].squaredNorm(), ++count;
        integral += area[i] * field[i].squaredNorm(), whole += area[i];
    }
    return std::sqrt(std::max(squares / count, integral / whole));
}

}  // namespace

Result watermark(const Layer& layer, const WatermarkOptions& options, Session& session) {
    Result result;
    const Start start(layer, options.relative_to, session, result.report);
    const Mesh& mesh = start.layer().mesh;
    require_usable(mesh);
    require(options.strength > 0 && options.strength <= 1, "strength must be more than 0 and at most 1");
    const std::vector<double> value = coefficients(options);
    const std::vector<double> weights = region_weights(layer, options.region);
    session.progress.report(0, "Placing the carriers");
    const Carriers carriers(mesh);
    session.progress.report(0.6, "Marking");
    const Array<Vec3> field = carriers.displacement(value, mesh.positions);
    const std::vector<double> area = area_shares(mesh.faces, mesh.positions);
    const double rms = rms_of(area, field);
    require(rms > 0, "The mesh has no vertex with a normal to move along");
    const double scale = options.strength / 100 * bounding_box(mesh.positions).diagonal() / rms;
    Positions after = mesh.positions;
    for (std::size_t i = 0; i < after.size(); ++i)
        if (area[i] > 0) after[i] += scale * field[i];  // vertices in no face stay
    blend(layer.mesh.positions, weights, after);
    report_change(layer, after, result.report);
    result.report.add("carriers", static_cast<int>(carriers.size()));
    result.report.add("carrier_spacing", carriers.spacing(), "mesh units");
    if (carriers.size() < Carriers::most)
        result.report.say("Only " + std::to_string(carriers.size()) + " of " + std::to_string(Carriers::most) +
                          " places for the mark, for want of vertices: the message may not be readable");
    result.positions = std::move(after);
    return result;
}

}  // namespace multires
