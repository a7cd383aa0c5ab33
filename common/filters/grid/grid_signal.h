#pragma once

#include "filters/filter.h"
#include "grids/affine.h"
#include "grids/grid_pyramid.h"
#include "schemes/field.h"

#include <string>
#include <vector>

/// What the filters of triangular grids share: the grids of a layer, and values at their vertices as samples.
namespace multires {

/// What of positions is transformed.
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
std::vector<GridPyramid> pyramids_of(const FoundGrids& found, const GridOptions& options);

/// The levels of a grid of the layer as other filters have them: one octave each.
std::vector<LevelInfo> level_infos(const GridPyramid& pyramid, const Layer& layer);

/// Values at the vertices of one grid: for each channel the affine function of the lattice's coordinates that is
/// nearest to them, and the rest as samples.
class GridSignal {
public:
    GridSignal(const Grid& grid, const Positions& positions, GridChannels channels);
    /// @param field  #V rows in order of the input
    GridSignal(const Grid& grid, const Field& field);

    const std::vector<Raster>& channels() const { return samples_; }
    /// The affine part of a channel at a point of the lattice; fractions are between points.
    double affine(std::size_t channel, double i, double j) const { return fit_.at(affine_[channel], i, j); }
    /// What other samples differ by.
    std::vector<Raster> change_to(std::vector<Raster> samples) const;
    /// Adds changes of the samples to the values they are of.
    void add(const std::vector<Raster>& change, Positions& positions) const;
    void add(const std::vector<Raster>& change, Field& field) const;

private:
    void take(const Field& field);
    void project_on_height();

    const Grid& grid_;
    Mask mask_;
    AffineFit fit_;
    std::vector<Affine> affine_;
    std::vector<Vec3> axes_;  // the direction of each channel of positions
    std::vector<Raster> samples_;
};

}  // namespace multires
