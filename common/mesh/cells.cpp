#include "mesh/cells.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace multires {
namespace {

/// The vertex farthest from a point; of those that are so but for rounding the first.
Index farthest(const Positions& p, const std::vector<Index>& cell, const Vec3& from) {
    constexpr double but_for_rounding = 1 - 1e-9;
    double most = 0;
    for (const Index v : cell) most = std::max(most, (p[v] - from).squaredNorm());
    Index first = -1;
    for (const Index v : cell)
        if ((first < 0 || v < first) && (p[v] - from).squaredNorm() >= but_for_rounding * most) first = v;
    return first;
}

/// How far each vertex of a cell is from one of its ends to the other, whole numbers, so that what is the same but for
/// rounding is the same.
std::vector<std::pair<std::int64_t, Index>> along(const Positions& p, const std::vector<Index>& cell) {
    Vec3 mean = Vec3::Zero();
    for (const Index v : cell) mean += p[v] / static_cast<double>(cell.size());
    const Vec3 begin = p[farthest(p, cell, mean)], way = p[farthest(p, cell, begin)] - begin;
    const double length = way.squaredNorm();
    constexpr double steps = 1 << 24;
    std::vector<std::pair<std::int64_t, Index>> out;
    out.reserve(cell.size());
    for (const Index v : cell)
        out.emplace_back(length > 0 ? std::llround(steps * way.dot(p[v] - begin) / length) : 0, v);
    return out;
}

void split(const Positions& p, std::vector<Index> cell, std::size_t most, std::vector<std::vector<Index>>& cells) {
    if (cell.size() <= most) {
        std::sort(cell.begin(), cell.end());
        cells.push_back(std::move(cell));
        return;
    }
    std::vector<std::pair<std::int64_t, Index>> place = along(p, cell);
    const auto half = static_cast<std::ptrdiff_t>(cell.size() / 2);
    std::nth_element(place.begin(), place.begin() + half, place.end());
    std::transform(place.begin(), place.end(), cell.begin(), [](const auto& at) { return at.second; });
    const auto middle = cell.begin() + half;
    split(p, {cell.begin(), middle}, most, cells);
    split(p, {middle, cell.end()}, most, cells);
}

}  // namespace

std::vector<std::vector<Index>> cells_of(const Positions& positions, Index most) {
    std::vector<std::vector<Index>> cells;
    std::vector<Index> all(positions.size());
    std::iota(all.begin(), all.end(), 0);
    if (!all.empty()) split(positions, std::move(all), static_cast<std::size_t>(std::max<Index>(most, 1)), cells);
    return cells;
}

}  // namespace multires
