#include "filters/editing/move_region.h"

#include "base/angles.h"
#include "base/hash.h"
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

/// What does not depend on the motion, kept with the layer for the next one.
class PreparedRegion final : public Intermediate {
public:
    using Intermediate::Intermediate;
    std::size_t bytes() const override {
        return sizeof *this + falloff.capacity() * sizeof(double) +
               (base.capacity() + normal.capacity()) * sizeof(Vec3);
    }

    std::vector<double> falloff;
    Positions base;      ///< without what is finer than half the falloff; empty if details need not follow
    Array<Vec3> normal;  ///< of its vertices
};

Positions base_of(const Layer& layer, const MoveRegionOptions& o, Session& session) {
    Report about_pyramid;  // which nobody needs who does not choose a level
    const auto pyramid = pyramid_of(layer, o.pyramid, session, about_pyramid);
    std::vector<double> gains(pyramid->hierarchy().levels.size(), 1);
    for (std::size_t k = 0; k < gains.size() && pyramid->levels()[k + 1].wavelength < o.between.falloff / 2; ++k)
        gains[k] = 0;
    return pyramid->synthesise(gains);
}

ContentHash region_hash(const Layer& layer, const MoveRegionOptions& o, bool details) {
    Hash hash;
    hash.add(std::array<int, 2>{static_cast<int>(IntermediateKind::moved_region), details});
    hash.add(content_hash(layer, o.pyramid));
    hash.add(std::array<double, 1>{o.between.falloff});
    for (const auto* selection : {&layer.selected_vertex, &layer.selected_face}) {
        hash.add(std::array<std::uint64_t, 1>{selection->size()});
        hash.add(*selection);
    }
    return hash.bits128();
}

/// @param details  are to follow
std::shared_ptr<const PreparedRegion> region_of(const Layer& layer, const MoveRegionOptions& o, bool details,
                                                Session& session) {
    const ContentHash hash = region_hash(layer, o, details), shape = shape_hash(layer.mesh.positions, layer.mesh.faces);
    return find_or_make<PreparedRegion>(session.intermediates, hash, shape, [&] {
        auto region = std::make_shared<PreparedRegion>(hash, shape);
        const Progress whole = session.progress;
        region->falloff = falloff_of(layer, o.between, whole.part(0, 0.5));
        const bool between =
            std::any_of(region->falloff.begin(), region->falloff.end(), [](double w) { return w > 0 && w < 1; });
        if (!details || !between) return region;
        session.progress = whole.part(0.5, 0.9);
        region->base = base_of(layer, o, session);
        region->normal = vertex_normals(layer.mesh.faces, region->base);
        session.progress = whole;
        return region;
    });
}

/// Turns the height over the base, which has moved by the rotation of its vertex, into the normal of the moved base.
void turn_details(const Mesh& mesh, const MoveRegionOptions& o, const PreparedRegion& region, Positions& after) {
    const std::vector<double>& t = region.falloff;
    const Array<Vec3> normal_after = vertex_normals(mesh.faces, moved(o, region.base, t));
    parallel_for(static_cast<Index>(t.size()), [&](Index i) {
        if (!(t[i] > 0 && t[i] < 1)) return;
        const Eigen::AngleAxisd turn(t[i] * radians(o.angle), o.axis);
        const Vec3& normal = region.normal[i];
        const double height = normal.dot(mesh.positions[i] - region.base[i]);
        after[i] += std::pow(o.scale, t[i]) * height * (normal_after[i] - turn * normal);
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
    const auto region = region_of(layer, options, options.details_follow && !still, session);
    Positions after = still ? x : moved(options, x, region->falloff);
    if (!still && !region->base.empty()) turn_details(layer.mesh, options, *region, after);
    whole.report(0.95, "Measuring the change");
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    if (options.store_falloff) result.quality = region->falloff;
    return result;
}

}  // namespace multires
