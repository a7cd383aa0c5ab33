#pragma once

#include "base/progress.h"
#include "grids/grid_pyramid.h"

#include <optional>
#include <vector>

namespace multires {

/// How the coefficients that are kept are chosen.
enum class Oracle {
    magnitude,  ///< the largest coefficients of the analysis, times the norms of their functions
    /// The functions that have most in common with what is left, some at a time; after each time the best values of all
    /// chosen ones (least squares by conjugate gradients), and if there are too many, the smallest go. The functions
    /// are over-complete by 7/3: this finds the few that do instead of the many that share.
    pursuit,
};

struct SparseOptions {
    Oracle oracle = Oracle::pursuit;
    std::size_t keep = 0;         ///< how many coefficients, at most
    std::optional<double> error;  ///< instead: as few as keep every sample within this distance, > 0
};

/// Few coefficients that give nearly the same samples.
struct Sparse {
    std::vector<Array<double>> coefficients;  ///< of each channel; zero where they were rejected
    std::vector<Raster> samples;              ///< what they give
    std::size_t kept = 0;
};

/// Channels share the choice: a coefficient has a value for each. Those of the scaling functions of the last level
/// count like the others.
/// @param channels  samples, 0 where the grid has no point; at least one
/// Cost: magnitude one analysis and one synthesis; pursuit some 100 of each.
Sparse sparse(const GridPyramid& pyramid, const std::vector<Raster>& channels, const SparseOptions& options,
              const Progress& progress);

}  // namespace multires
