#include "normals/face_geometry.h"

#include "base/parallel.h"
#include "base/reduce.h"

#include <cmath>

namespace multires {
namespace {

/// Between centroids of faces with a common edge; 0 without such faces.
double mean_distance(const FaceGraph& graph, const FaceGeometry& g) {
    const auto mean = chunked_fold<Mean>(graph.edges.size(), [&](Mean& part, std::size_t e) {
        const Index a = graph.edges[e][0], b = graph.edges[e][1];
        if (g.area[a] > 0 && g.area[b] > 0) part.add((g.centroid[a] - g.centroid[b]).norm());
    });
    return mean.value();
}

}  // namespace

FaceGeometry face_geometry(const Faces& faces, const Positions& p) {
    const Index count = static_cast<Index>(faces.size());
    FaceGeometry g{Array<Vec3>(count), std::vector<double>(count), Positions(count)};
    parallel_for(count, [&](Index f) {
        const Vec3 &a = p[faces[f][0]], &b = p[faces[f][1]], &c = p[faces[f][2]];
        const Vec3 n = (b - a).cross(c - a);
        const double length = n.norm();
        g.area[f] = length / 2;
        g.normal[f] = length > 0 ? Vec3(n / length) : Vec3(Vec3::Zero());
        g.centroid[f] = (a + b + c) / 3;
    });
    return g;
}

std::vector<double> spatial_weights(const FaceGraph& graph, const FaceGeometry& g, double reach) {
    const double sigma = reach * mean_distance(graph, g);
    const double scale = sigma > 0 ? 1 / (2 * sigma * sigma) : 0;
    std::vector<double> w(graph.neighbor.size());
    parallel_for(static_cast<Index>(g.area.size()), [&](Index f) {
        for (Index k = graph.offset[f]; k < graph.offset[f + 1]; ++k) {
            const Index h = graph.neighbor[k];
            w[k] = g.area[h] * std::exp(-(g.centroid[f] - g.centroid[h]).squaredNorm() * scale);
        }
    });
    return w;
}

}  // namespace multires
