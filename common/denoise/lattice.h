#pragma once

#include "mesh/mesh.h"

#include <optional>

namespace multires {

/// The step of the lattice along the axes of space that all coordinates lie on, as they do when they were rounded, mesh
/// units. Nothing if there is none, or none of at least `least`.
/// Cost: O(#V log #V)
std::optional<double> lattice_step(const Positions& positions, double least);

/// True if every vertex is on the middle of an edge of a cubic grid of two steps, as marching cubes put it on the
/// boundary of voxels that are only inside or outside: two coordinates are even multiples of the step, one is odd.
/// @param step  lattice_step()
bool between_voxels(const Positions& positions, double step);

/// Moves each coordinate to within so much of where it was: the truth that was rounded to it is there.
void keep_within_cells(const Positions& rounded, double farthest, Positions& positions);

}  // namespace multires
