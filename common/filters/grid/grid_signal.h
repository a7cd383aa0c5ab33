#pragma once

#include "filters/filter.h"
#include "grids/grid_pyramid.h"

#include <string>
#include <vector>

/// What the filters of triangular grids share: the grids of a layer, and their positions as samples.
namespace multires {

/// What is transformed.
enum class GridChannels {
    positions,  ///< all three coordinates: parametric surfaces, range maps of any shape
    heights,    ///< along the direction in which the surface leaves its plane most: z of a terrain; nothing else moves
};

struct GridOptions {
    SplineBasis basis = SplineBasis::quartic;
    GridChannels channels = GridChannels::positions;
    int levels = 0;  ///< 1 to 16, less where the grid is too small; 0: down to about 4 by 4 points
};

/// The grids of a layer.
/// @throws InputError  for meshes that are not usable or no grids (see find_grids), and levels out of range
FoundGrids grids_of(const Layer& layer, const GridOptions& options);

GridPyramid pyramid_of(const Grid& grid, const GridOptions& options);

/// The levels of a grid of the layer as other filters have them: one octave each.
std::vector<LevelInfo> level_infos(const GridPyramid& pyramid, const Layer& layer);

/// Positions of one grid: the affine function of the lattice's coordinates that is nearest to them, which every scaling
/// function reproduces, and the rest as samples. What is left of a plane is nothing, up to its outline.
class GridSignal {
public:
    GridSignal(const Grid& grid, const Positions& positions, GridChannels channels);

    const std::vector<Raster>& channels() const { return samples_; }
    /// The affine part at a point of the lattice; fractions are between points.
    Vec3 affine(double i, double j) const { return middle_ + (i - mean_i_) * along_i_ + (j - mean_j_) * along_j_; }
    /// What other samples differ by.
    std::vector<Raster> change_to(std::vector<Raster> samples) const;
    /// Adds changes of the samples to positions of the vertices.
    void add(const std::vector<Raster>& change, Positions& positions) const;

private:
    void fit(const Positions& positions);

    const Grid& grid_;
    double mean_i_ = 0, mean_j_ = 0;
    Vec3 middle_, along_i_, along_j_;
    std::vector<Vec3> axes_;  // the direction of each channel
    std::vector<Raster> samples_;
};

}  // namespace multires
