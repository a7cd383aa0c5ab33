#pragma once

#include "mesh/mesh.h"

#include <vector>

namespace multires {

/// Vertices in boxes of about equal numbers: halves along the longest side of what they fill, until a cell has at most
/// `most` of them.
/// @returns  cells, each of indices in ascending order; a mesh without vertices has none
/// Cost: O(V log V)
std::vector<std::vector<Index>> cells_of(const Positions& positions, Index most);

}  // namespace multires
