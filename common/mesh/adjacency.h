#pragma once

#include "mesh/mesh.h"
#include "mesh/rings.h"

#include <cstdint>
#include <vector>

namespace multires {

/// Ordered 1-rings of all vertices of a mesh, row i belonging to vertex i (see Rings).
///
/// Faces with a repeated index do not count. A vertex is irregular if one of its edges has more than two faces, or
/// its faces form more than one fan, or only two faces that are each other's back; isolated if it has no face.
/// Faces of inconsistent orientation are accepted: rings follow edges, not orientation.
///
/// @param mesh  face indices must be in range
/// @return      #V rows, without flaps and features
/// Cost: linear in the mesh, O(d log d) for a vertex of valence d.
Rings vertex_rings(const Mesh& mesh);

/// The same, where a face with the three vertices of another one, in any order, does not count: the rings of the
/// surface, which duplicate faces and the backs of double-sided ones add nothing to.
Rings surface_rings(const Mesh& mesh);

/// The neighbour along the boundary of a boundary vertex that comes after `from`; `at` itself if the boundary cannot be
/// followed there, or if a feature edge meets it.
/// @param rings  row i = vertex i
Index next_on_boundary(const Rings& rings, Index from, Index at);

/// Fills Rings::flap of rows that together hold every vertex (row i = vertex i): the vertex across each link edge
/// of closed rows, and the next vertex of the boundary beyond both ends of open ones; none if the link edge lies on the
/// boundary, is a feature, or touches an irregular vertex on both ends.
void find_flaps(Rings& rings);

/// The same for one row of such rings, into room for as many as it has entries.
void find_flaps(const Rings& rings, Index row, Index* flap);

/// Marks as features the edges whose faces' normals differ by more than `degrees` (Rings::feature). Boundary edges
/// are not features. Both ends of an edge get the same mark.
void mark_features_by_angle(Rings& rings, const Positions& positions, double degrees);

/// Marks as features the edges named by bit k of `edges[f]` = edge (k, k+1) of face f, in addition to those marked.
/// @param edges  #F, e.g. the edges that are not faux, or selected ones
void mark_features(Rings& rings, const Faces& faces, const std::vector<std::uint8_t>& edges);

/// Vertices in breadth-first order over the rings, so that neighbours have near numbers wherever the mesh's own order
/// jumps about. Depends on the connectivity alone; serial, linear in the entries.
Array<Index> breadth_first_order(const Rings& rings);

}  // namespace multires
