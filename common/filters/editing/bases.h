#pragma once

#include "editing/multiband.h"
#include "filters/filter.h"

#include <vector>

namespace multires {

/// How the sizes of the bases follow each other (Vorsatz and Kobbelt, section 3).
enum class BandLevels {
    ratio,         ///< by a constant ratio of the numbers of vertices kept
    edge_length,   ///< by a constant ratio of the mean edge lengths of the meshes that these make
    equal_detail,  ///< so that all bands have the same detail, by the levels of the pyramid
};

/// A base of a mesh: the vertices that its hierarchy keeps longest stay, the others go to where the bending energy, the
/// integral of the squared Laplacian of the mesh as it is, is least.
struct Base {
    Positions positions;
    int steps = 0;  ///< of the solver
};

/// @param kept  how many stay, at least those of the pyramid's base and at most all
/// @param tolerance, most_steps  of the solver
Base base_through(const Mesh& mesh, const Pyramid& pyramid, Index kept, double tolerance, int most_steps,
                  const Progress& progress);

/// How many vertices the bases of a mesh keep, finest first; the last keeps `coarsest`.
/// @param count     of bases, at least 1
/// @param coarsest  at least those of the pyramid's base and at most all
std::vector<Index> kept_by_bases(const Pyramid& pyramid, BandLevels levels, int count, Index coarsest);

/// The bases need not be exact, as details make up for it: few steps of the solver.
/// @param coarsest  if not null, the last base: #V by 3
Multiband multiband_of(const Mesh& mesh, const Pyramid& pyramid, const std::vector<Index>& kept,
                       const Positions* coarsest, const Progress& progress);

}  // namespace multires
