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

double squared_distance(const Wedge& a, const Wedge& b) {
    return (a.u - b.u) * (a.u - b.u) + (a.v - b.v) * (a.v - b.v);
}

}  // namespace

WedgeCharts::WedgeCharts(Index vertices, const Faces& faces, std::vector<Wedge> corners)
    : corners_(std::move(corners)), first_(vertices + 1, 0), around_(3 * faces.size()), chart_(faces.size()) {
    for (const Face& f : faces)
        for (Index v : f) ++first_[v + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    for (Index c = 0; c < static_cast<Index>(around_.size()); ++c) around_[next[faces[c / 3][c % 3]]++] = c;

    std::iota(chart_.begin(), chart_.end(), 0);
    for (Index v = 0; v < vertices; ++v) {
        const auto begin = around_.begin() + first_[v];
        const auto end = around_.begin() + first_[v + 1];
        std::sort(begin, end, [&](Index a, Index b) {
            return std::make_pair(key(corners_[a]), a) < std::make_pair(key(corners_[b]), b);
        });
        for (auto c = begin; c != end && c + 1 != end; ++c)
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

}  // namespace multires
