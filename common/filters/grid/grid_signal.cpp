#include "filters/grid/grid_signal.h"

#include "base/parallel.h"
#include "measure/measure.h"
#include "mesh/validation.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// Calls visit(i, j, vertex) for the points of a grid that have one.
template <class Visit>
void for_points(const Grid& grid, const Visit& visit) {
    for (Index i = 0; i < grid.rows; ++i)
        for (Index j = 0; j < grid.columns; ++j) {
            const Index v = grid.vertex[static_cast<std::size_t>(i) * grid.columns + j];
            if (v >= 0) visit(i, j, v);
        }
}

}  // namespace

FoundGrids grids_of(const Layer& layer, const GridOptions& options) {
    require_usable(layer.mesh);
    require(options.levels >= 0 && options.levels <= 16, "levels must be between 0 and 16");
    return find_grids(layer.mesh.faces, static_cast<Index>(layer.mesh.positions.size()));
}

GridPyramid pyramid_of(const Grid& grid, const GridOptions& options) {
    const double side = std::sqrt(static_cast<double>(grid.vertices));
    const int automatic = std::clamp(static_cast<int>(std::floor(std::log2(side / 4))), 1, 16);
    return GridPyramid(grid, options.basis, options.levels > 0 ? options.levels : automatic);
}

std::vector<LevelInfo> level_infos(const GridPyramid& pyramid, const Layer& layer) {
    std::vector<LevelInfo> infos;
    const double finest = 2 * mean_edge_length(layer.mesh.faces, layer.mesh.positions);
    for (int k = 0; k <= pyramid.levels(); ++k) {
        const Array<std::uint8_t>& there = pyramid.mask(k).values;
        LevelInfo info;
        info.vertices = static_cast<Index>(std::count(there.begin(), there.end(), 1));
        info.wavelength = std::ldexp(finest, k);
        infos.push_back(info);
    }
    return infos;
}

GridSignal::GridSignal(const Grid& grid, const Positions& positions, GridChannels channels) : grid_(grid) {
    fit(positions);
    const auto rest = [&](Index i, Index j, Index v) -> Vec3 { return positions[v] - affine(i, j); };
    if (channels == GridChannels::positions) {
        axes_ = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    } else {
        // A terrain leaves its affine part along z alone, however it slopes.
        Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
        double largest = 0;
        for_points(grid, [&](Index i, Index j, Index v) { largest = std::max(largest, rest(i, j, v).norm()); });
        if (largest > 0)
            for_points(grid, [&](Index i, Index j, Index v) {
                const Vec3 r = rest(i, j, v) / largest;
                spread += r * r.transpose();
            });
        axes_ = {Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2)};
    }
    samples_.assign(axes_.size(), Raster(grid.rows, grid.columns, 0));
    for_points(grid, [&](Index i, Index j, Index v) {
        const Vec3 r = rest(i, j, v);
        for (std::size_t c = 0; c < axes_.size(); ++c) samples_[c].row(i)[j] = axes_[c].dot(r);
    });
}

/// Least squares about the means. A single row of points has no slope across.
void GridSignal::fit(const Positions& positions) {
    middle_ = along_i_ = along_j_ = Vec3::Zero();
    const double share = 1.0 / grid_.vertices;
    for_points(grid_, [&](Index i, Index j, Index v) {
        mean_i_ += share * i, mean_j_ += share * j;
        middle_ += share * positions[v];
    });
    double ii = 0, ij = 0, jj = 0;
    Vec3 pi = Vec3::Zero(), pj = Vec3::Zero();
    for_points(grid_, [&](Index i, Index j, Index v) {
        const double a = i - mean_i_, b = j - mean_j_;
        ii += share * a * a, ij += share * a * b, jj += share * b * b;
        const Vec3 p = share * (positions[v] - middle_);
        pi += a * p, pj += b * p;
    });
    const double determinant = ii * jj - ij * ij;
    if (determinant > 1e-9 * (ii + jj)) {
        along_i_ = (jj * pi - ij * pj) / determinant;
        along_j_ = (ii * pj - ij * pi) / determinant;
    }
}

std::vector<Raster> GridSignal::change_to(std::vector<Raster> samples) const {
    for (std::size_t c = 0; c < samples.size(); ++c)
        for (std::size_t p = 0; p < samples[c].values.size(); ++p) samples[c].values[p] -= samples_[c].values[p];
    return samples;
}

void GridSignal::add(const std::vector<Raster>& change, Positions& positions) const {
    for_points(grid_, [&](Index i, Index j, Index v) {
        for (std::size_t c = 0; c < axes_.size(); ++c) positions[v] += change[c].row(i)[j] * axes_[c];
    });
}

}  // namespace multires
