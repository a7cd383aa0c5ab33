#pragma once

#include "base/array.h"
#include "mesh/mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace multires {

/// A mesh whose faces know their edges by lengths only: edges run within its surface.
struct IntrinsicMesh {
    Faces faces;  ///< as many as the mesh has; two may share the same two corners, or all three
    /// #F by 3: of the edges (0, 1), (1, 2), (2, 0); only those of changed faces are set.
    Array<std::array<double, 3>> length;
    Array<std::uint8_t> changed;  ///< #F; empty if no edge was turned
};

/// Turns edges within the surface until it has no edge whose opposite angles sum to more than 180 degrees: the
/// intrinsic Delaunay triangulation (Bobenko and Springborn 2007; Fisher, Springborn, Schroeder and Bobenko 2006). The
/// vertices, distances along the surface and its area stay. Edges of one face, of three or more, of faces of opposite
/// orientation and those between two vertices of `held` stay.
/// @param cotangent  cotangent(face, k): of the angle opposite to the edge (k, k + 1)
/// @param usable     #F: 0 for faces that are not to be touched
/// Cost: linear and parallel to look, serial for what is turned.
IntrinsicMesh intrinsic_delaunay(const Mesh& mesh, const Array<std::array<double, 3>>& cotangent,
                                 const Array<std::uint8_t>& usable, const std::vector<std::uint8_t>& held);

}  // namespace multires
