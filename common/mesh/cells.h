#pragma once

#include "mesh/mesh.h"

#include <vector>

namespace multires {

/// Vertices in parts of about equal numbers: halves across the way from one end of what they fill to the other, until a
/// cell has at most `most` of them. They turn, move and scale with the mesh.
/// @returns  cells, each of indices in ascending order; a mesh without vertices has none
/// Cost: O(V log V)
std::vector<std::vector<Index>> cells_of(const Positions& positions, Index most);

}  // namespace multires
