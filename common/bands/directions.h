#pragma once

#include "mesh/mesh.h"
#include "solvers/stiffness.h"

namespace multires {

/// Unit normals of the vertices up to their sign: sums of the area vectors of each vertex' faces. Where orientations
/// contradict each other, so that these cancel, area vectors are turned to agree with those before them. Zero for
/// vertices without area.
/// @returns  #V by 3
Array<Vec3> directions(const Faces& faces, const Positions& positions);

/// Takes from the way of each vertex from mesh.positions to `smooth` the part along the surface `smooth`, as far as no
/// face turns by more than 45 degrees against that surface (where that has turned a face over among its neighbours,
/// against those). Where one would, its vertices take 0.7 of what is left of that part, those around them follow a
/// little, and so on. In the end they slide back where they can (slide.h).
/// @param neighbours  of the mesh: offset and column
/// @param smooth      #V by 3; the result afterwards
/// Cost: linear; a pass over the faces for each step, 30 at most. Same bits for any number of threads.
void move_along_normals(const Mesh& mesh, const Stiffness& neighbours, Positions& smooth);

}  // namespace multires
