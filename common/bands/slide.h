#pragma once

#include "mesh/mesh.h"
#include "solvers/stiffness.h"

namespace multires {

/// Lets vertices that lie off the normals of the low-passed surface through where they were slide back along it, one
/// after the other, as long as that lessens the sum, over a vertex and its neighbours, of
///
///     area (|way across the normal of the result|^2 + |way across the normal of the low-passed surface there|^2)
///
/// and no face leans by more than 60 degrees against that surface or a neighbour, or farther than it has. The second
/// normal keeps vertices from lessening the first by crumpling the result. Vertices whose faces do not agree on a side
/// stay. Up to 15 rounds over those whose surroundings moved.
/// @param neighbours  of the mesh: offset and column
/// @param smooth      #V by 3, the low-passed surface
/// @param moved       #V by 3, near it
/// Cost: linear, up to 0.3 s of one core for 100,000 vertices; next to nothing where drift() is below 0.05 already.
void slide_back(const Mesh& mesh, const Stiffness& neighbours, const Positions& smooth, Positions& moved);

}  // namespace multires
