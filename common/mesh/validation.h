#pragma once

#include "base/error.h"
#include "mesh/mesh.h"
#include "mesh/rings.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace multires {

/// What is unusual about an input; all of it is handled, and none of it is changed.
struct InputCounts {
    Index vertices = 0, faces = 0;
    Index unreferenced_vertices = 0;  ///< in no face
    Index duplicate_vertices = 0;     ///< at exactly the position of a vertex before them
    Index degenerate_faces = 0;       ///< with a repeated index; left out of all counts below
    Index zero_area_faces = 0;        ///< three different indices, but 2 area <= 1e-10 x sum of squared edge lengths
    Index duplicate_faces = 0;        ///< with the vertices, in any order, of a face before them
    Index boundary_edges = 0;         ///< in one face
    Index boundary_loops = 0;         ///< connected boundary edges; loops that touch count as one
    Index non_manifold_edges = 0;     ///< in three faces or more
    Index non_manifold_vertices = 0;  ///< RingKind::irregular: these are never moved or removed
    Index inconsistent_edges = 0;     ///< in two faces that pass it in the same direction
    Index components = 0;             ///< sets of faces connected by vertices
    Index non_orientable_components = 0;  ///< sets of faces connected by edges of two faces; Möbius bands
};

/// #V flags: which vertices some face has, degenerate or not.
std::vector<std::uint8_t> vertices_in_faces(const Mesh& mesh);

/// Counts what is unusual.
/// @param mesh       face indices in range
/// @param irregular  how many of its surface_rings() are RingKind::irregular, if that is known
/// Cost: linear in the mesh for bounded valences.
InputCounts count_input(const Mesh& mesh, Index irregular);
InputCounts count_input(const Mesh& mesh);

/// Does nothing if filters can work on the mesh.
/// @throws InputError  for no vertices, no faces, coordinates that are not finite, a box whose diagonal is zero or more
///                     than can be squared safely (outside 1e-70 .. 1e70), or no face with an area; with a message for
///                     the user
/// Cost: linear.
void require_usable(const Mesh& mesh);

/// True for values of attributes that filters can compute with: finite, and what can be squared safely (to 1e70).
inline bool is_usable(double value) { return std::abs(value) <= 1e70; }

}  // namespace multires
