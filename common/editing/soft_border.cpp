#include "editing/soft_border.h"

#include "base/array.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

namespace multires {
namespace {

/// Both neighbours of each corner's vertex, in rows.
struct Neighbours {
    Array<Index> offset, vertex;

    explicit Neighbours(const Mesh& mesh) : offset(mesh.positions.size() + 1, 0) {
        for (const Face& f : mesh.faces)
            for (const Index v : f) offset[v + 1] += 2;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) offset[v + 1] += offset[v];
        vertex.resize(offset.back());
        Array<Index> next(offset.begin(), offset.end() - 1);
        for (const Face& f : mesh.faces)
            for (int k = 0; k < 3; ++k) {
                vertex[next[f[k]]++] = f[(k + 1) % 3];
                vertex[next[f[k]]++] = f[(k + 2) % 3];
            }
    }
};

}  // namespace

std::vector<double> distances_along_edges(const Mesh& mesh, const std::vector<std::uint8_t>& marked, double limit) {
    const Neighbours neighbours(mesh);
    std::vector<double> distance(mesh.positions.size(), std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    const auto visit = [&](Index v, double d) {
        if (!(d < distance[v]) || d > limit) return;
        distance[v] = d;
        queue.emplace(d, v);
    };
    for (std::size_t v = 0; v < marked.size(); ++v)
        if (marked[v]) distance[v] = 0;
    for (std::size_t v = 0; v < marked.size(); ++v)  // from the border alone
        if (marked[v])
            for (Index k = neighbours.offset[v]; k < neighbours.offset[v + 1]; ++k) {
                const Index w = neighbours.vertex[k];
                visit(w, (mesh.positions[w] - mesh.positions[v]).norm());
            }
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (d > distance[v]) continue;
        for (Index k = neighbours.offset[v]; k < neighbours.offset[v + 1]; ++k) {
            const Index w = neighbours.vertex[k];
            visit(w, d + (mesh.positions[w] - mesh.positions[v]).norm());
        }
    }
    return distance;
}

void soften_border(const Mesh& mesh, double width, std::vector<double>& weights) {
    if (!(width > 0)) return;
    std::vector<std::uint8_t> outside(weights.size());
    for (std::size_t v = 0; v < weights.size(); ++v) outside[v] = weights[v] == 0;
    if (std::find(outside.begin(), outside.end(), 1) == outside.end()) return;
    const std::vector<double> distance = distances_along_edges(mesh, outside, width);
    for (std::size_t v = 0; v < weights.size(); ++v) {
        const double s = std::min(1.0, distance[v] / width);
        weights[v] *= s * s * (3 - 2 * s);
    }
}

}  // namespace multires
