#include "mesh/cells.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace multires {
namespace {

int longest_side(const Positions& p, const std::vector<Index>& cell) {
    Vec3 low = p[cell.front()], high = low;
    for (const Index v : cell) {
        low = low.cwiseMin(p[v]);
        high = high.cwiseMax(p[v]);
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    return axis;
}

void split(const Positions& p, std::vector<Index> cell, std::size_t most, std::vector<std::vector<Index>>& cells) {
    if (cell.size() <= most) {
        std::sort(cell.begin(), cell.end());
        cells.push_back(std::move(cell));
        return;
    }
    const int axis = longest_side(p, cell);
    const auto middle = cell.begin() + static_cast<std::ptrdiff_t>(cell.size() / 2);
    std::nth_element(cell.begin(), middle, cell.end(),
                     [&](Index a, Index b) { return p[a][axis] < p[b][axis] || (p[a][axis] == p[b][axis] && a < b); });
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
