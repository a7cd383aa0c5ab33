#include "normals/guided_normals.h"

#include "base/parallel.h"
#include "normals/face_geometry.h"
#include "normals/falling_weight.h"
#include "normals/normal_field.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr double tolerance = 0.2;  ///< deviation of the weights over differences of guides
constexpr double reach = 1.6;      ///< of the weights over distances, see spatial_weights()
constexpr int fit_steps = 8;

Vec3 unit_or(const Vec3& v, const Vec3& other) {
    const double length = v.norm();
    return length > 0 ? Vec3(v / length) : other;
}

/// Differences of the normals over the edges of each face.
struct EdgeDifferences {
    std::vector<double> largest, sum;  ///< #F
};

EdgeDifferences edge_differences(const FaceGraph& graph, const Array<Vec3>& normal) {
    EdgeDifferences d{std::vector<double>(normal.size(), 0), std::vector<double>(normal.size(), 0)};
    for (const auto& edge : graph.edges) {
        const double difference = (normal[edge[0]] - normal[edge[1]]).norm();
        for (const Index f : edge) {
            d.largest[f] = std::max(d.largest[f], difference);
            d.sum[f] += difference;
        }
    }
    return d;
}

struct Patches {
    Array<Vec3> mean;               ///< #F by 3: unit, of the patch around each face
    std::vector<double> roughness;  ///< #F: how far its normals are apart, and how much of that at one edge
};

Patches patches_of(const FaceGraph& graph, const FaceGeometry& g) {
    const EdgeDifferences edge = edge_differences(graph, g.normal);
    Patches patches{Array<Vec3>(g.normal.size()), std::vector<double>(g.normal.size())};
    parallel_for(static_cast<Index>(g.normal.size()), [&](Index f) {
        double spread = 0, largest = edge.largest[f], sum = edge.sum[f];
        Vec3 mean = g.area[f] * g.normal[f];
        for (Index k = graph.offset[f]; k < graph.offset[f + 1]; ++k) {
            const Index h = graph.neighbor[k];
            spread = std::max(spread, (g.normal[f] - g.normal[h]).squaredNorm());
            largest = std::max(largest, edge.largest[h]);
            sum += edge.sum[h];
            mean += g.area[h] * g.normal[h];
        }
        patches.mean[f] = unit_or(mean, g.normal[f]);
        patches.roughness[f] = std::sqrt(spread) * largest / (1e-9 + sum);
    });
    return patches;
}

/// The mean of the patch with the least roughness; that of all if several are alike, so that rounding decides nothing.
Array<Vec3> guides(const FaceGraph& graph, const Patches& patches) {
    Array<Vec3> guide(patches.mean.size());
    parallel_for(static_cast<Index>(guide.size()), [&](Index f) {
        double least = patches.roughness[f];
        for (Index k = graph.offset[f]; k < graph.offset[f + 1]; ++k)
            least = std::min(least, patches.roughness[graph.neighbor[k]]);
        const double alike = least * (1 + 1e-6) + 1e-9;
        Vec3 sum = patches.roughness[f] <= alike ? patches.mean[f] : Vec3(Vec3::Zero());
        for (Index k = graph.offset[f]; k < graph.offset[f + 1]; ++k)
            if (patches.roughness[graph.neighbor[k]] <= alike) sum += patches.mean[graph.neighbor[k]];
        guide[f] = unit_or(sum, patches.mean[f]);
    });
    return guide;
}

Array<Vec3> filtered(const FaceGraph& graph, const std::vector<double>& spatial, const FaceGeometry& g,
                     const Array<Vec3>& guide) {
    constexpr double scale = 1 / (2 * tolerance * tolerance);
    Array<Vec3> out(guide.size());
    parallel_for(static_cast<Index>(guide.size()), [&](Index f) {
        Vec3 sum = g.area[f] * g.normal[f];
        for (Index k = graph.offset[f]; k < graph.offset[f + 1]; ++k) {
            const Index h = graph.neighbor[k];
            const double exponent = (guide[f] - guide[h]).squaredNorm() * scale;
            if (exponent < 40) sum += spatial[k] * falling_weight(exponent) * g.normal[h];
        }
        out[f] = unit_or(sum, g.normal[f]);
    });
    return out;
}

}  // namespace

Positions guided_steps(const Faces& faces, const Positions& positions, const Incidence& at, const FaceGraph& graph,
                       int steps, const std::vector<std::uint8_t>& moves) {
    Positions p = positions;
    std::vector<double> spatial;
    for (int step = 0; step < steps; ++step) {
        const FaceGeometry g = face_geometry(faces, p);
        if (step == 0) spatial = spatial_weights(graph, g, reach);
        const Array<Vec3> guide = guides(graph, patches_of(graph, g));
        p = fit_vertices(faces, p, at, filtered(graph, spatial, g, guide), fit_steps, moves);
    }
    return p;
}

}  // namespace multires
