#pragma once

#include "hierarchy/hierarchy.h"

#include <vector>

namespace multires {

/// The finest wave that each level can carry: twice the mean edge length of its mesh, mesh units.
///
/// Where the base is in several parts, or has vertices that it was not to have, those that cannot be taken stay from
/// level to level (specks beside a scan, vertices that are not manifold) and say nothing of how coarse the others are.
/// There it is twice the mean length of the edges at the vertices that the level takes away, which in other meshes is
/// within a few percent of the same.
/// @param faces          #F by 3, those of level 0
/// @param base_vertices  HierarchyOptions::base_vertices
/// @returns #levels + 1
/// Cost: linear; a level's mesh where the hierarchy has no mean edge lengths. With thousands of levels, a few are
/// measured and those between follow, in the logarithm.
std::vector<double> wavelengths(const Hierarchy& hierarchy, const Faces& faces, Index base_vertices);

}  // namespace multires
