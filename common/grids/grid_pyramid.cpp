#include "grids/grid_pyramid.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace multires {
namespace {

/// Steps to the points within a distance along the lattice, nearest first.
std::vector<std::array<Index, 2>> steps_within(Index radius) {
    std::vector<std::array<Index, 2>> steps;
    const auto length = [](const std::array<Index, 2>& s) {
        return std::max({std::abs(s[0]), std::abs(s[1]), std::abs(s[0] - s[1])});
    };
    for (Index i = -radius; i <= radius; ++i)
        for (Index j = -radius; j <= radius; ++j)
            if (length({i, j}) <= radius) steps.push_back({i, j});
    std::stable_sort(steps.begin(), steps.end(), [&](const auto& a, const auto& b) { return length(a) < length(b); });
    return steps;
}

double norm_of(const Raster& r) {
    double sum = 0;
    for (const double x : r.values) sum += x * x;
    return std::sqrt(sum);
}

}  // namespace

int usual_levels(const Grid& grid) {
    const double side = std::sqrt(static_cast<double>(grid.vertices));
    return std::clamp(static_cast<int>(std::floor(std::log2(side / 4))), 1, 16);
}

Raster subdivided(const Raster& coarse, SplineBasis basis, Index rows, Index columns) {
    return synthesise({coarse.values.data()}, basis, rows, columns);
}

GridPyramid::GridPyramid(const Grid& grid, SplineBasis basis, int levels) : basis_(basis) {
    Shape finest;
    finest.mask = Mask(grid.rows, grid.columns, 0);
    finest.source = grid.vertex;
    for (std::size_t p = 0; p < grid.vertex.size(); ++p) finest.mask.values[p] = grid.vertex[p] >= 0;
    shapes_.push_back(std::move(finest));
    do {
        add_level();
    } while (this->levels() < levels && band_size(this->levels() - 1) < mask(this->levels() - 1).values.size());
    for (int k = 0; k < this->levels(); ++k) size_ += 7 * band_size(k);
    size_ += band_size(this->levels() - 1);
    measure_norms();
}

std::size_t GridPyramid::offset(int level, int type) const {
    std::size_t at = 0;
    for (int k = 0; k < level; ++k) at += 7 * band_size(k);
    return at + static_cast<std::size_t>(type == 0 ? 7 : type - 1) * band_size(level);
}

void GridPyramid::add_level() {
    const Shape& fine = shapes_.back();
    const CoarseBox box = coarse_box(basis_, fine.mask.rows, fine.mask.columns);
    const auto steps = steps_within(reach(basis_));
    Shape coarse;
    coarse.mask = Mask(box.rows, box.columns, 0);
    coarse.source.assign(coarse.mask.values.size(), -1);
    parallel_for(
        box.rows,
        [&](Index x) {
            for (Index y = 0; y < box.columns; ++y)
                for (const auto& s : steps) {
                    const Index i = 2 * (x + box.first) + s[0], j = 2 * (y + box.first) + s[1];
                    if (i < 0 || j < 0 || i >= fine.mask.rows || j >= fine.mask.columns || !fine.mask.row(i)[j])
                        continue;
                    coarse.mask.row(x)[y] = 1;
                    coarse.source[static_cast<std::size_t>(x) * box.columns + y] =
                        fine.source[static_cast<std::size_t>(i) * fine.mask.columns + j];
                    break;
                }
        },
        16);
    shapes_.push_back(std::move(coarse));
}

/// A function is synthesised on as many points as it reaches.
void GridPyramid::measure_norms() {
    norm_.resize(levels());
    Index side = 1;
    for (int k = 0; k < levels(); ++k) {
        side = 2 * side + 4 * reach(basis_);
        for (int type = 0; type < subbands; ++type) {
            if (k > 5) {  // longer waves have the same shape, 4 times the points
                norm_[k][type] = 2 * norm_[k - 1][type];
                continue;
            }
            std::vector<Index> sides{side};
            for (int m = 0; m <= k; ++m) sides.push_back(coarse_box(basis_, sides.back(), sides.back()).rows);
            Raster r(sides.back(), sides.back(), 0);
            r.row(r.rows / 2)[r.columns / 2] = 1;
            std::array<const double*, subbands> one{};
            one[type] = r.values.data();
            r = multires::synthesise(one, basis_, sides[k], sides[k]);
            for (int m = k; m-- > 0;) r = subdivided(r, basis_, sides[m], sides[m]);
            norm_[k][type] = norm_of(r);
        }
    }
}

/// The details, where there are points.
void GridPyramid::store(int level, const std::array<Raster, subbands>& bands, Array<double>& to) const {
    const Array<std::uint8_t>& there = mask(level + 1).values;
    for (int type = level + 1 == levels() ? 0 : 1; type < subbands; ++type) {
        double* const at = to.data() + offset(level, type);
        for (std::size_t p = 0; p < there.size(); ++p) at[p] = there[p] ? bands[type].values[p] : 0;
    }
}

Array<double> GridPyramid::analyse(const Raster& samples) const {
    Array<double> out(size_);
    Raster current = samples;
    for (int k = 0; k < levels(); ++k) {
        std::array<Raster, subbands> bands = multires::analyse(current, mask(k), basis_);
        store(k, bands, out);
        current = std::move(bands[0]);
    }
    return out;
}

Array<double> GridPyramid::correlate(const Raster& samples) const {
    Array<double> out(size_);
    Raster current = samples;
    for (int k = 0; k < levels(); ++k) {
        clear_outside(mask(k), current);
        std::array<Raster, subbands> bands = multires::correlate(current, basis_);
        store(k, bands, out);
        current = std::move(bands[0]);
    }
    return out;
}

Raster GridPyramid::synthesise(const Array<double>& coefficients, int to) const {
    const int last = levels() - 1;
    Raster current;
    current.rows = mask(levels()).rows, current.columns = mask(levels()).columns;
    const double* const base = coefficients.data() + offset(last, 0);
    current.values.assign(base, base + band_size(last));
    for (int k = last; k >= to; --k) {
        std::array<const double*, subbands> bands{current.values.data()};
        for (int type = 1; type < subbands; ++type) bands[type] = coefficients.data() + offset(k, type);
        current = multires::synthesise(bands, basis_, mask(k).rows, mask(k).columns);
        if (k > 0) clear_outside(mask(k), current);  // what the rim got belongs to no function that was kept
    }
    return current;
}

Raster GridPyramid::refine(Raster samples, int from, int to) const {
    for (int k = from; k-- > to;) {
        samples = subdivided(samples, basis_, mask(k).rows, mask(k).columns);
        clear_outside(mask(k), samples);
    }
    return samples;
}

}  // namespace multires
