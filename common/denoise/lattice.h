#pragma once

#include "mesh/mesh.h"

#include <optional>

namespace multires {

/// The step of the lattice along the axes of space that all coordinates lie on, as they do when they were rounded, mesh
/// units. Nothing if there is none, or none of at least `least`.
/// Cost: O(#V log #V)
std::optional<double> lattice_step(const Positions& positions, double least);

/// Moves each coordinate to within half a step of where it was: the truth that was rounded to it is there.
void keep_within_cells(const Positions& rounded, double step, Positions& positions);

}  // namespace multires
