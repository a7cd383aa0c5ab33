#pragma once

#include "filters/grid/grid_signal.h"
#include "filters/original.h"
#include "filters/region.h"
#include "pyramid/band.h"

/// Bands of box-spline wavelets on triangular grids (Dreger, Gross and Schlegel).
namespace multires {

struct ComputeGridOptions {
    GridOptions grid;
};

/// Reports the grids that the layer consists of, and for the largest one how much energy each type of wavelets has at
/// each level: sum of squares of its coefficients times the norm of their functions.
/// @throws InputError  for a mesh that is no triangular grid, saying why
Result compute_grid(const Layer& layer, const ComputeGridOptions& options, Session& session);

struct GridBandOptions {
    GridOptions grid;
    Band band;          ///< level k holds waves of 2^(k+1) to 2^(k+2) mean edge lengths
    double gain = 0;    ///< of the details in the band, finite
    std::string gains;  ///< if not empty, instead: one for each level, finest first, separated by commas
    Region region;
    RelativeTo relative_to = RelativeTo::current;
};

/// Gains of the levels of one grid of the layer.
/// @throws InputError  for limits and gains
std::vector<double> grid_gains(const GridBandOptions& options, const GridPyramid& pyramid, const Layer& layer);

/// What they change of a signal's samples.
std::vector<Raster> change_by_gains(const GridSignal& signal, const GridPyramid& pyramid,
                                    const std::vector<double>& gains);

/// Scales the details of some levels; gains of 1 leave every vertex exactly where it is. Vertices in no grid stay.
/// @throws InputError  for a mesh that is no triangular grid, limits and gains
/// Cost: linear.
Result grid_band(const Layer& layer, const GridBandOptions& options, Session& session);

}  // namespace multires
