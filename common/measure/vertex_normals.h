#pragma once

#include "mesh/mesh.h"

namespace multires {

/// The normal of a face, as long as twice its area.
inline Vec3 area_vector(const Face& f, const Positions& p) { return (p[f[1]] - p[f[0]]).cross(p[f[2]] - p[f[0]]); }

/// Sum of the area vectors of each vertex's faces, twice the area long; zero for vertices without faces.
/// @returns  #V by 3, square mesh units
Array<Vec3> vertex_area_vectors(const Faces& faces, const Positions& positions);

/// The same as unit vectors, the usual vertex normals; zero where the sum is.
Array<Vec3> vertex_normals(const Faces& faces, const Positions& positions);

}  // namespace multires
