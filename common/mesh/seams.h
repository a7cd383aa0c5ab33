#pragma once

#include "mesh/layer.h"

#include <vector>

/// Meshes that are cut along seams: exporters write a vertex twice where texture coordinates or normals jump, and files
/// without connectivity write it once for each face. The two sides of such a cut are one surface.
namespace multires {

/// A mesh with its seams closed.
struct JoinedVertices {
    std::vector<Index> joined;  ///< #V: the vertex of the closed mesh
    std::vector<Index> first;   ///< #V': the first of the vertices that became it, ascending

    /// The vertex of the closed mesh; `v` itself if nothing was joined.
    Index of(Index v) const { return joined.empty() ? v : joined[v]; }
    Face of(const Face& f) const { return {of(f[0]), of(f[1]), of(f[2])}; }
};

/// Joins vertices at exactly the same place where that closes a boundary: two boundary edges with the same ends, passed
/// in opposite directions, and no third one there. Surfaces that only touch stay apart, and so do sheets that lie on
/// one another (faces that would fold back by more than 150 degrees). Empty if there is nothing to join.
/// @param mesh  face indices in range; coordinates that are not finite are nowhere
/// Cost: linear, a pass over the faces if no two boundary vertices are at one place
JoinedVertices join_seams(const Mesh& mesh);

/// The same, but a seam stays open along edges at whose ends its two sides have different values.
/// @param seams       join_seams(layer.mesh), not empty
/// @param attributes  indices into Layer::attributes of the values that count
JoinedVertices join_seams_where_alike(const Layer& layer, const JoinedVertices& seams,
                                      const std::vector<std::size_t>& attributes);

}  // namespace multires
