#pragma once

#include "mesh/mesh.h"

#include <vector>

namespace multires {

/// Lets weights rise smoothly from the border of a region: multiplies those that are not 0 by s^2 (3 - 2 s), where s is
/// the distance along edges to the nearest vertex of weight 0, in units of `width`, at most 1. Without a vertex of
/// weight 0 nothing changes.
/// @param width    mesh units; 0: nothing changes
/// @param weights  #V
/// Cost: O(n log n) in the vertices within the border.
void soften_border(const Mesh& mesh, double width, std::vector<double>& weights);

/// Distances along edges to the nearest of the vertices marked, up to a limit; infinite beyond it.
/// @param marked  #V
/// Cost: O(n log n) in the vertices within the limit, and linear in the mesh.
std::vector<double> distances_along_edges(const Mesh& mesh, const std::vector<std::uint8_t>& marked, double limit);

}  // namespace multires
