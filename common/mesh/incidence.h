#pragma once

#include "base/buckets.h"
#include "mesh/mesh.h"

namespace multires {

/// Faces of each vertex, ascending; a face that repeats a vertex comes as often.
using Incidence = Buckets<Index>;

/// @param vertices  #V; face indices are in range
/// Cost: linear.
Incidence vertex_faces(const Faces& faces, Index vertices);

}  // namespace multires
