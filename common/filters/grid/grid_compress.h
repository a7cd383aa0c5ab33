#pragma once

#include "filters/grid/grid_signal.h"
#include "filters/region.h"
#include "grids/pursuit.h"

namespace multires {

/// What says how many coefficients are kept.
enum class KeepBy {
    share,  ///< of the number of vertices
    error,  ///< the largest distance of a vertex
};

/// Keeps few coefficients of box-spline wavelets of a triangular grid (Dreger, Gross and Schlegel, Figures 17 and 18).
struct GridCompressOptions {
    GridOptions grid;
    KeepBy keep_by = KeepBy::share;
    double share = 10;  ///< percent of the vertices, more than 0, at most 100
    double error = 1;   ///< mesh units, > 0
    Oracle oracle = Oracle::pursuit;
    Region region;
};

/// The surface that the kept coefficients and an affine function of the lattice give. Reports how many they are, the
/// error, and its energy in percent of that of the samples, which are what the affine function leaves.
/// @throws InputError  for a mesh that is no triangular grid and options out of range
/// Cost: see sparse().
Result grid_compress(const Layer& layer, const GridCompressOptions& options, Session& session);

}  // namespace multires
