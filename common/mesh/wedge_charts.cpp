#include "mesh/wedge_charts.h"

#include <algorithm>
#include <cstring>
#include <numeric>
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

Index find(std::vector<Index>& parent, Index i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

/// Corners by vertex: those of vertex i are around[first[i]] .. around[first[i+1]], ascending.
void sort_corners(Index vertices, const Faces& faces, std::vector<Index>& first, std::vector<Index>& around) {
    first.assign(vertices + 1, 0);
    around.resize(3 * faces.size());
    for (const Face& f : faces)
        for (const Index v : f) ++first[v + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Index> next(first.begin(), first.end() - 1);
    for (Index c = 0; c < static_cast<Index>(around.size()); ++c) around[next[faces[c / 3][c % 3]]++] = c;
}

/// Sorts the corners of one vertex so that equal wedges are neighbours.
void sort_by_wedge(const std::vector<Wedge>& corners, Index* begin, Index* end) {
    std::sort(begin, end, [&](Index a, Index b) {
        return std::make_pair(key(corners[a]), a) < std::make_pair(key(corners[b]), b);
    });
}

double squared_distance(const Wedge& a, const Wedge& b) {
    return (a.u - b.u) * (a.u - b.u) + (a.v - b.v) * (a.v - b.v);
}

}  // namespace

WedgeCharts::WedgeCharts(Index vertices, const Faces& faces, std::vector<Wedge> corners)
    : corners_(std::move(corners)), chart_(faces.size()) {
    sort_corners(vertices, faces, first_, around_);
    std::iota(chart_.begin(), chart_.end(), 0);
    for (Index v = 0; v < vertices; ++v) {
        Index* const begin = around_.data() + first_[v];
        Index* const end = around_.data() + first_[v + 1];
        sort_by_wedge(corners_, begin, end);
        for (const Index* c = begin; c != end && c + 1 != end; ++c)
            if (key(corners_[*c]) == key(corners_[*(c + 1)])) chart_[find(chart_, *c / 3)] = find(chart_, *(c + 1) / 3);
    }
    for (Index f = 0; f < static_cast<Index>(faces.size()); ++f) chart_[f] = find(chart_, f);
}

const Wedge& WedgeCharts::wedge(Index vertex, Index face, int k) const {
    const Wedge& own = corners_[3 * face + k];
    const Wedge* best = nullptr;
    for (Index i = first_[vertex]; i < first_[vertex + 1]; ++i) {
        const Wedge& candidate = corners_[around_[i]];
        if (chart_[around_[i] / 3] != chart_[face]) continue;
        if (!best || squared_distance(candidate, own) < squared_distance(*best, own)) best = &candidate;
    }
    return best ? *best : own;
}

CutMesh cut_along_seams(const Mesh& mesh, const std::vector<Wedge>& wedges) {
    const Index vertices = static_cast<Index>(mesh.positions.size());
    std::vector<Index> first, around;
    sort_corners(vertices, mesh.faces, first, around);
    CutMesh cut;
    cut.node.resize(around.size());
    for (Index v = 0; v < vertices; ++v) {
        cut.nodes_of.push_back(static_cast<Index>(cut.vertex.size()));
        sort_by_wedge(wedges, around.data() + first[v], around.data() + first[v + 1]);
        for (Index i = first[v]; i < first[v + 1]; ++i) {
            const Wedge& w = wedges[around[i]];
            if (i == first[v] || key(w) != key(wedges[around[i - 1]])) {
                cut.vertex.push_back(v);
                cut.wedge.push_back(w);
                cut.mesh.positions.push_back(mesh.positions[v]);
            }
            cut.node[around[i]] = static_cast<Index>(cut.vertex.size()) - 1;
        }
    }
    cut.nodes_of.push_back(static_cast<Index>(cut.vertex.size()));
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Face& v = mesh.faces[f];
        const Index* n = cut.node.data() + 3 * f;
        const bool repeats = v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
        cut.mesh.faces.push_back(repeats ? Face{n[0], n[0], n[0]} : Face{n[0], n[1], n[2]});
    }
    return cut;
}

}  // namespace multires
