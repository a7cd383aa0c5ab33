#include "filters/editing/move_region.h"

#include "base/angles.h"
#include "base/parallel.h"
#include "editing/falloff.h"
#include "filters/region.h"
#include "measure/vertex_normals.h"
#include "mesh/validation.h"
#include "pyramid/band.h"
#include "pyramid/pyramid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace multires {
namespace {

bool nothing_selected(const Layer& layer) { return layer.selected_vertex.empty() && layer.selected_face.empty(); }

std::vector<double> falloff_of(const Layer& layer, const FalloffOptions& options, const Progress& progress) {
    require(options.falloff >= 0 && std::isfinite(options.falloff), "falloff must be a number, 0 or more");
    if (nothing_selected(layer)) return std::vector<double>(layer.mesh.positions.size(), 1);
    Region region;
    region.selected = true;
    const std::vector<double> selected = region_weights(layer, region);
    const std::vector<std::uint8_t> inside(selected.begin(), selected.end());
    return falloff(layer.mesh, inside, options.falloff, progress);
}

void check(const MoveRegionOptions& o) {
    require(o.pivot.allFinite() && o.translation.allFinite() && o.axis.allFinite() && std::isfinite(o.angle),
            "pivot, axis, angle and translation must be numbers");
    require(o.scale > 0 && std::isfinite(o.scale), "scale must be a number above 0");
}

/// Where a point goes.
Vec3 moved(const MoveRegionOptions& o, const Vec3& x, double t) {
    const Eigen::AngleAxisd turn(t * radians(o.angle), o.axis);
    return o.pivot + std::pow(o.scale, t) * (turn * (x - o.pivot)) + t * o.translation;
}

Positions moved(const MoveRegionOptions& o, const Positions& x, const std::vector<double>& t) {
    Positions after = x;
    parallel_for(static_cast<Index>(x.size()), [&](Index i) {
        if (t[i] > 0) after[i] = moved(o, x[i], t[i]);
    });
    return after;
}

/// Without what is finer than half the falloff.
Positions base_of(const Layer& layer, const MoveRegionOptions& o, Session& session) {
    Report about_pyramid;  // which nobody needs who does not choose a level
    const auto pyramid = pyramid_of(layer, o.pyramid, session, about_pyramid);
    std::vector<double> gains(pyramid->hierarchy().levels.size(), 1);
    for (std::size_t k = 0; k < gains.size() && pyramid->levels()[k + 1].wavelength < o.between.falloff / 2; ++k)
        gains[k] = 0;
    return pyramid->synthesise(gains);
}

/// Turns the height over the base, which has moved by the rotation of its vertex, into the normal of the moved base.
void turn_details(const Mesh& mesh, const MoveRegionOptions& o, const Positions& base, const std::vector<double>& t,
                  Positions& after) {
    const Array<Vec3> normal = vertex_normals(mesh.faces, base);
    const Array<Vec3> normal_after = vertex_normals(mesh.faces, moved(o, base, t));
    parallel_for(static_cast<Index>(base.size()), [&](Index i) {
        if (!(t[i] > 0 && t[i] < 1)) return;
        const Eigen::AngleAxisd turn(t[i] * radians(o.angle), o.axis);
        const double height = normal[i].dot(mesh.positions[i] - base[i]);
        after[i] += std::pow(o.scale, t[i]) * height * (normal_after[i] - turn * normal[i]);
    });
}

}  // namespace

Result falloff_quality(const Layer& layer, const FalloffOptions& options, Session& session) {
    require_usable(layer.mesh);
    Result result;
    if (nothing_selected(layer)) result.report.say("Nothing is selected: the whole layer counts as the region.");
    result.quality = falloff_of(layer, options, session.progress);
    const auto between =
        std::count_if(result.quality->begin(), result.quality->end(), [](double t) { return t > 0 && t < 1; });
    result.report.add("vertices_inside",
                      static_cast<int>(std::count(result.quality->begin(), result.quality->end(), 1.0)));
    result.report.add("vertices_between", static_cast<int>(between));
    return result;
}

Result move_region(const Layer& layer, const MoveRegionOptions& options, Session& session) {
    require_usable(layer.mesh);
    check(options);
    Result result;
    const Progress whole = session.progress;
    const Positions& x = layer.mesh.positions;
    const bool still = options.angle == 0 && options.scale == 1 && options.translation == Vec3::Zero();
    require(still || !nothing_selected(layer),
            "Nothing is selected: select the vertices or faces that are to move. The "
            "surface around them follows up to falloff");
    if (still) result.report.say("No motion is given: set translation, angle or scale.");
    std::vector<double> t = falloff_of(layer, options.between, whole.part(0, 0.5));
    Positions after = still ? x : moved(options, x, t);
    const bool between = std::any_of(t.begin(), t.end(), [](double w) { return w > 0 && w < 1; });
    if (options.details_follow && between && !still) {
        session.progress = whole.part(0.5, 0.9);
        const Positions base = base_of(layer, options, session);
        session.progress = whole;
        turn_details(layer.mesh, options, base, t, after);
    }
    whole.report(0.95, "Measuring the change");
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    if (options.store_falloff) result.quality = std::move(t);
    return result;
}

}  // namespace multires
