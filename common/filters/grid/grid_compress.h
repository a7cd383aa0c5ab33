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

/// @throws InputError  for options out of range
void check(const GridCompressOptions& options);

/// Sums over the vertices of all grids.
struct CompressionErrors {
    double squares = 0, energy = 0, largest = 0, vertices = 0, kept = 0;

    void add(const std::vector<Raster>& error, const std::vector<Raster>& samples);
    /// @param label  in front of each key
    void tell(const std::string& label, const std::string& unit, Report& report) const;
};

/// What is lost of the samples of one grid.
std::vector<Raster> change_by_compression(const GridSignal& signal, const Grid& grid, const GridPyramid& pyramid,
                                          const GridCompressOptions& options, const Progress& progress,
                                          CompressionErrors& errors);

/// The surface that the kept coefficients and an affine function of the lattice give. Reports how many they are, the
/// error, and its energy in percent of that of the samples, which are what the affine function leaves.
/// @throws InputError  for a mesh that is no triangular grid and options out of range
/// Cost: see sparse().
Result grid_compress(const Layer& layer, const GridCompressOptions& options, Session& session);

}  // namespace multires
