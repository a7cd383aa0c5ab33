#include "filters/layers/level_region.h"

#include "base/parallel.h"
#include "base/reduce.h"
#include "filters/region.h"
#include "hierarchy/refinement.h"
#include "measure/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace multires {
namespace {

std::vector<double> distance_from_selection(const Layer& layer) {
    Region region;
    region.selected = true;
    std::vector<double> inside;
    try {
        inside = region_weights(layer, region);
    } catch (const InputError&) {
        throw InputError("detail_in: nothing is selected; select vertices or faces, or choose another region");
    }
    Faces points;  // a vertex is a face whose corners are all there
    for (std::size_t i = 0; i < inside.size(); ++i)
        if (inside[i] > 0) points.push_back({static_cast<Index>(i), static_cast<Index>(i), static_cast<Index>(i)});
    require(!points.empty(), "detail_in: nothing is selected; select vertices or faces, or choose another region");
    const SurfaceTree tree(points, layer.mesh.positions);
    std::vector<double> distance(inside.size());
    parallel_chunks(static_cast<Index>(inside.size()), 1024, [&](Index begin, Index end) {
        Index hint = -1;
        for (Index i = begin; i < end; ++i) {
            const SurfaceTree::Hit hit = tree.closest(layer.mesh.positions[i], hint);
            hint = hit.face;
            distance[i] = inside[i] > 0 ? 0 : std::sqrt(hit.squared);
        }
    });
    return distance;
}

/// Mean length of the edges along which the finest level's vertices go.
double usual_edge(const Hierarchy& h, const Positions& input) {
    Mean mean;
    if (!h.levels.empty())
        for (Index place = h.levels[0].coarse; place < h.levels[0].fine; ++place)
            mean.add((input[h.order[place]] - input[h.order[h.parent[place]]]).norm());
    return mean.value() > 0 ? mean.value() : 1;
}

double distance_from_box(const Vec3& p, const Vec3& low, const Vec3& high) {
    return (low - p).cwiseMax(p - high).cwiseMax(0).norm();
}

}  // namespace

std::vector<double> region_distance(const Layer& layer, const GenerateLevelOptions& options) {
    require(options.growth >= 0 && std::isfinite(options.growth), "growth must be a number, 0 or more");
    if (options.detail_in == DetailIn::selection) return distance_from_selection(layer);
    const bool box = options.detail_in == DetailIn::box;
    require(!box || (options.low.array() <= options.high.array()).all(),
            "high: the box must not end below where it begins, low");
    require(box || (options.radius >= 0 && std::isfinite(options.radius)), "radius must be a number, 0 or more");
    std::vector<double> distance(layer.mesh.positions.size());
    parallel_for(static_cast<Index>(distance.size()), [&](Index i) {
        const Vec3& p = layer.mesh.positions[i];
        distance[i] = box ? distance_from_box(p, options.low, options.high)
                          : std::max(0.0, (p - options.centre).norm() - options.radius);
    });
    return distance;
}

std::vector<std::uint8_t> level_of_region(const Hierarchy& h, const Positions& positions,
                                          const std::vector<double>& distance, const Coarsening& how) {
    // Edges of a level of n vertices are about as long as the square root of the area a vertex; unit: those of the
    // input. A vertex is kept where the edges of its level may be as long as the place allows, or longer.
    const double edge = usual_edge(h, positions);
    const auto length = [&](Index place) { return std::sqrt(static_cast<double>(h.vertices()) / (place + 1)); };
    const double longest = how.exact ? std::numeric_limits<double>::infinity() : length(how.count - 1);
    std::vector<double> importance(h.vertices());
    for (Index p = 0; p < h.vertices(); ++p) {
        const double d = distance[h.order[p]];
        importance[p] =
            d > 0 ? length(p) / std::min(longest, 1 + how.growth * d / edge) : std::numeric_limits<double>::infinity();
    }
    const Insertion order = insertion_order(h, std::move(importance));
    if (!how.exact) return inserted(order, order.count(1));
    const Index inside = order.count(std::numeric_limits<double>::infinity());
    require(how.count >= inside,
            "vertices: the region alone, with what it hangs on, has " + std::to_string(inside) + " vertices");
    return inserted(order, how.count);
}

}  // namespace multires
