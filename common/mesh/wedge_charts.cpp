#include "mesh/wedge_charts.h"

#include "base/disjoint_sets.h"

#include <algorithm>
#include <cstring>
#include <tuple>
#include <utility>

namespace multires {

namespace {

std::uint64_t bits(double x) {
    x += 0.0;  // one zero, not two
    std::uint64_t b = 0;
    std::memcpy(&b, &x, sizeof b);
    return b;
}

// A total order in which equal wedges are neighbours, NaN included.
std::tuple<int, std::uint64_t, std::uint64_t> key(const Wedge& w) { return {w.texture, bits(w.u), bits(w.v)}; }

/// The corners of each vertex, sorted so that equal wedges are neighbours.
Buckets<Index> corners_by_wedge(Index vertices, const Faces& faces, const std::vector<Wedge>& corners) {
    Buckets<Index> around(vertices, static_cast<Index>(3 * faces.size()), [&](Index c) { return faces[c / 3][c % 3]; });
    for (Index v = 0; v < vertices; ++v)
        std::sort(around[v].begin(), around[v].end(), [&](Index a, Index b) {
            return std::make_pair(key(corners[a]), a) < std::make_pair(key(corners[b]), b);
        });
    return around;
}

double squared_distance(const Wedge& a, const Wedge& b) {
    return (a.u - b.u) * (a.u - b.u) + (a.v - b.v) * (a.v - b.v);
}

}  // namespace

WedgeCharts::WedgeCharts(Index vertices, const Faces& faces, std::vector<Wedge> corners)
    : corners_(std::move(corners)), around_(corners_by_wedge(vertices, faces, corners_)), chart_(faces.size()) {
    DisjointSets charts(static_cast<Index>(faces.size()));
    for (Index v = 0; v < vertices; ++v)
        for (Index i = 1; i < around_[v].size(); ++i) {
            const Index a = around_[v][i - 1], b = around_[v][i];
            if (key(corners_[a]) == key(corners_[b])) charts.join(a / 3, b / 3);
        }
    for (Index f = 0; f < static_cast<Index>(faces.size()); ++f) chart_[f] = charts.find(f).root;
}

const Wedge& WedgeCharts::wedge(Index vertex, Index face, int k) const {
    const Wedge& own = corners_[3 * face + k];
    const Wedge* best = nullptr;
    for (const Index c : around_[vertex]) {
        const Wedge& candidate = corners_[c];
        if (chart_[c / 3] != chart_[face]) continue;
        if (!best || squared_distance(candidate, own) < squared_distance(*best, own)) best = &candidate;
    }
    return best ? *best : own;
}

FacePair::FacePair(const Face& of_level, const Face& of_input) : now(of_level), then(of_input) {
    int best = -1;
    for (int t = 0; t < 3; ++t) {
        const int same = (now[0] == then[t]) + (now[1] == then[(1 + t) % 3]) + (now[2] == then[(2 + t) % 3]);
        if (same > best) best = same, turn = t;
    }
}

CutMesh cut_along_seams(const Mesh& mesh, const std::vector<Wedge>& wedges) {
    const Index vertices = static_cast<Index>(mesh.positions.size());
    const Buckets<Index> around = corners_by_wedge(vertices, mesh.faces, wedges);
    CutMesh cut;
    cut.node.resize(around.items());
    for (Index v = 0; v < vertices; ++v) {
        cut.nodes_of.push_back(static_cast<Index>(cut.vertex.size()));
        for (Index i = 0; i < around[v].size(); ++i) {
            const Wedge& w = wedges[around[v][i]];
            if (i == 0 || key(w) != key(wedges[around[v][i - 1]])) {
                cut.vertex.push_back(v);
                cut.wedge.push_back(w);
                cut.mesh.positions.push_back(mesh.positions[v]);
            }
            cut.node[around[v][i]] = static_cast<Index>(cut.vertex.size()) - 1;
        }
    }
    cut.nodes_of.push_back(static_cast<Index>(cut.vertex.size()));
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Face& v = mesh.faces[f];
        const Index* n = cut.node.data() + 3 * f;
        cut.mesh.faces.push_back(repeats_an_index(v) ? Face{n[0], n[0], n[0]} : Face{n[0], n[1], n[2]});
    }
    return cut;
}

}  // namespace multires
