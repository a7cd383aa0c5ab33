#include "filters/grid/grid_signal.h"

#include "base/decompositions.h"
#include "base/parallel.h"
#include "measure/measure.h"
#include "mesh/validation.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

Mask mask_of(const Grid& grid) {
    Mask mask(grid.rows, grid.columns, 0);
    for (std::size_t p = 0; p < grid.vertex.size(); ++p) mask.values[p] = grid.vertex[p] >= 0;
    return mask;
}

}  // namespace

FoundGrids grids_of(const Layer& layer, const GridOptions& options) {
    require_usable(layer.mesh);
    require(options.levels >= 0 && options.levels <= 16, "levels must be between 0 and 16");
    return find_grids(layer.mesh.faces, static_cast<Index>(layer.mesh.positions.size()));
}

GridPyramid pyramid_of(const Grid& grid, const GridOptions& options) {
    return GridPyramid(grid, options.basis, options.levels > 0 ? options.levels : usual_levels(grid));
}

std::vector<GridPyramid> pyramids_of(const FoundGrids& found, const GridOptions& options) {
    std::vector<GridPyramid> pyramids;
    for (const Grid& grid : found.grids) pyramids.push_back(pyramid_of(grid, options));
    return pyramids;
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

GridSignal::GridSignal(const Grid& grid, const Field& field) : grid_(grid), mask_(mask_of(grid)), fit_(mask_) {
    take(field);
}

GridSignal::GridSignal(const Grid& grid, const Positions& positions, GridChannels channels)
    : GridSignal(grid, field_of(positions)) {
    axes_ = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    if (channels == GridChannels::heights) project_on_height();
}

void GridSignal::take(const Field& field) {
    for (int c = 0; c < field.width; ++c) {
        Raster samples(grid_.rows, grid_.columns, 0);
        for (std::size_t p = 0; p < grid_.vertex.size(); ++p)
            if (mask_.values[p]) samples.values[p] = field.row(grid_.vertex[p])[c];
        affine_.push_back(fit_.of(mask_, samples));
        for (Index i = 0; i < grid_.rows; ++i)
            for (Index j = 0; j < grid_.columns; ++j)
                if (mask_.row(i)[j]) samples.row(i)[j] -= affine(static_cast<std::size_t>(c), i, j);
        samples_.push_back(std::move(samples));
    }
}

/// A terrain leaves its affine part along z alone, however it slopes.
void GridSignal::project_on_height() {
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    const auto rest = [&](std::size_t p) {
        return Vec3(samples_[0].values[p], samples_[1].values[p], samples_[2].values[p]);
    };
    double largest = 0;
    for (std::size_t p = 0; p < mask_.values.size(); ++p) largest = std::max(largest, rest(p).norm());
    for (std::size_t p = 0; largest > 0 && p < mask_.values.size(); ++p) {
        const Vec3 r = rest(p) / largest;
        spread += r * r.transpose();
    }
    axes_ = {principal_axes(spread).vectors.col(2)};
    Raster heights(grid_.rows, grid_.columns, 0);
    for (std::size_t p = 0; p < mask_.values.size(); ++p) heights.values[p] = axes_[0].dot(rest(p));
    samples_ = {std::move(heights)};
}

std::vector<Raster> GridSignal::change_to(std::vector<Raster> samples) const {
    for (std::size_t c = 0; c < samples.size(); ++c)
        for (std::size_t p = 0; p < samples[c].values.size(); ++p) samples[c].values[p] -= samples_[c].values[p];
    return samples;
}

void GridSignal::add(const std::vector<Raster>& change, Positions& positions) const {
    for (std::size_t p = 0; p < mask_.values.size(); ++p)
        for (std::size_t c = 0; mask_.values[p] && c < axes_.size(); ++c)
            positions[grid_.vertex[p]] += change[c].values[p] * axes_[c];
}

void GridSignal::add(const std::vector<Raster>& change, Field& field) const {
    for (std::size_t p = 0; p < mask_.values.size(); ++p)
        for (std::size_t c = 0; mask_.values[p] && c < change.size(); ++c)
            field.row(grid_.vertex[p])[c] += change[c].values[p];
}

}  // namespace multires
