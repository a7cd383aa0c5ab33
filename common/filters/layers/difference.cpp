#include "filters/layers/difference.h"

#include "base/blocks.h"
#include "filters/placement.h"
#include "measure/signed_distance.h"
#include "measure/triangles.h"
#include "mesh/validation.h"
#include "pyramid/bodies.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// Refuses what no distance can be measured to, and says of which layer.
void require_reference(const Layer& reference, const Layer& current) {
    require(&reference != &current, "layer: it is the current layer itself; choose another one");
    try {
        require_usable(reference.mesh);
    } catch (const InputError& e) {
        throw InputError(std::string("layer: ") + e.what());
    }
}

/// Signed distances of points to the reference.
std::vector<double> distances(const Positions& points, const Layer& reference, const Progress& progress) {
    progress.report(0, "Sorting the faces of the reference");
    const Positions placed = in_world(reference, "the other layer");
    const SignedDistance surface(reference.mesh.faces, placed);
    const double out = reference.to_world.topLeftCorner<3, 3>().determinant() < 0 ? -1 : 1;
    std::vector<double> distance(points.size());
    parallel_blocks(static_cast<Index>(points.size()), progress.part(0.3, 1), "Measuring the distance",
                    [&](Index begin, Index end) {
                        Index hint = -1;
                        for (Index i = begin; i < end; ++i) {
                            const SignedDistance::Hit hit = surface.at(points[i], hint);
                            distance[i] = hit.distance == 0 ? 0 : out * hit.distance;
                            hint = hit.face;
                        }
                    });
    return distance;
}

/// The part of a function on the layer that is as coarse as the wavelength, or coarser.
std::vector<double> low_passed(const std::vector<double>& values, const Layer& layer, const DifferenceOptions& options,
                               Session& session, Report& report) {
    const auto pyramid = pyramid_of(layer, options.pyramid, session, report);
    Band band;
    band.coarsest = options.wavelength;
    const Bodies bodies(*pyramid, layer);
    const Gains gains = band_gains(bodies, band, box_diagonal(layer), 0);
    report.add("gains", gains[0]);
    Field field = Field::unset(static_cast<Index>(values.size()), 1);
    field.has_positions = false;
    std::copy(values.begin(), values.end(), field.values.begin());
    const Field smooth = bodies.filter(field, gains);
    return {smooth.values.begin(), smooth.values.end()};
}

/// Vertices without a face count for nothing.
void report_difference(const Mesh& mesh, const Positions& world, const std::vector<double>& value, double beyond,
                       Report& report) {
    const std::vector<double> area = area_shares(mesh.faces, world);
    const std::vector<std::uint8_t> used = vertices_in_faces(mesh);
    double total = 0, sum = 0, squares = 0, outside = 0;
    double largest = -std::numeric_limits<double>::infinity(), smallest = -largest;
    for (std::size_t i = 0; i < value.size(); ++i) {
        if (!used[i]) continue;
        total += area[i];
        sum += area[i] * value[i];
        squares += area[i] * value[i] * value[i];
        if (std::abs(value[i]) > beyond) outside += area[i];
        largest = std::max(largest, value[i]);
        smallest = std::min(smallest, value[i]);
    }
    report.add("rms_difference", total > 0 ? std::sqrt(squares / total) : 0, "mesh units");
    report.add("mean_difference", total > 0 ? sum / total : 0, "mesh units");
    report.add("largest_difference", largest, "mesh units");
    report.add("smallest_difference", smallest, "mesh units");
    report.add("share_beyond", total > 0 ? outside / total : 0);
}

}  // namespace

Result difference_to_layer(const Inputs& inputs, const DifferenceOptions& options, Session& session) {
    const Layer& layer = inputs.current;
    require_usable(layer.mesh);
    const Layer& reference = inputs.other(options.layer, "layer");
    require_reference(reference, layer);
    require(options.wavelength >= 0 && std::isfinite(options.wavelength), "wavelength must be a number, 0 or more");
    require(options.beyond >= 0 && std::isfinite(options.beyond), "beyond must be a number, 0 or more");
    Result result;
    const Positions world = in_world(layer, "the current layer");
    std::vector<double> value =
        distances(world, reference, session.progress.part(0, options.wavelength > 0 ? 0.4 : 0.95));
    const Progress whole = session.progress;
    session.progress = whole.part(0.4, 0.95);
    if (options.wavelength > 0) value = low_passed(value, layer, options, session, result.report);
    session.progress = whole;
    whole.report(0.95, "Adding up");
    report_difference(layer.mesh, world, value, options.beyond, result.report);
    result.quality = std::move(value);
    return result;
}

}  // namespace multires
