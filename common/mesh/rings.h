#pragma once

#include "base/array.h"
#include "mesh/mesh.h"

#include <cstdint>
#include <vector>

namespace multires {

/// What the neighbourhood of a vertex looks like.
enum class RingKind : std::uint8_t {
    closed,     ///< a disk: the 1-ring is a cycle
    open,       ///< a half disk: the 1-ring is a chain whose two ends are the boundary neighbours
    irregular,  ///< non-manifold edge or vertex: no ring is stored, the vertex is never moved or removed
    isolated,   ///< in no face that counts: no ring
};

/// Ordered 1-rings of many vertices in compressed rows. Row r belongs to the vertex `vertex(r)`.
///
/// The entries of a row are the 1-ring neighbours in order around the vertex: entries j and j+1 and the vertex are a
/// triangle; on a closed row so are the last, the first and the vertex. Rows follow the orientation of the faces
/// where that is consistent; nothing but the sign of normals may depend on it (Möbius bands have rows too).
/// All entries of a row differ. Closed rows have at least 3 entries, open ones at least 2.
struct Rings {
    Array<Index> offset{0};  ///< #rows+1
    Array<Index> neighbor;   ///< #entries
    /// #entries or empty: vertex beyond the link edge (j, j+1); neighbour j itself if there is none or the edge is a
    /// feature, so that sums over flaps need not ask. Open rows have flaps at their ends alone: the next vertices of
    /// the boundary, unless a feature meets it at the end.
    Array<Index> flap;
    Array<std::uint8_t> feature;  ///< #entries or empty: 1 if the edge (vertex, neighbor) is a feature edge
    Array<RingKind> kind;         ///< #rows
    Array<Index> vertices;        ///< #rows or empty: vertex of each row; empty if row r belongs to vertex first+r
    Index first = 0;              ///< see `vertices`

    Index rows() const { return static_cast<Index>(kind.size()); }
    Index vertex(Index row) const { return vertices.empty() ? first + row : vertices[row]; }
    Index size(Index row) const { return offset[row + 1] - offset[row]; }
    bool has_flap(Index entry) const { return flap[entry] != neighbor[entry]; }
    const Index* begin(Index row) const { return neighbor.data() + offset[row]; }
};

}  // namespace multires
