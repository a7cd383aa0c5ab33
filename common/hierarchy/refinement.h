#pragma once

#include "hierarchy/hierarchy.h"

#include <cstdint>
#include <vector>

/// Meshes between the base and the input that hold a chosen set of vertices (Roy et al. 2003, section 4.3).
///
/// A vertex depends on its ring at the moment it is removed (Level::odd). A set that holds the base and, with every
/// vertex, all it depends on is closed. For a closed set the collapses of the vertices outside it can be carried out in
/// their order, and each meets exactly the ring it was checked with when the hierarchy was built: a ring could only
/// differ by a neighbour that was removed earlier but is in the set, and that neighbour depends on the vertex. So every
/// closed set gives a mesh with the topology of the input, whose faces all come from collapses that were allowed.
namespace multires {

/// The order in which vertices are inserted as a threshold falls.
struct Insertion {
    std::vector<double> key;   ///< #V by place: the vertex is in the mesh of every threshold <= key; base: infinity
    std::vector<Index> order;  ///< #V places: the base, then by falling key; all prefixes from the base on are closed
    std::vector<std::uint8_t> faces;  ///< #V by place: faces that inserting the vertex adds: 2, at a boundary 1, base 0

    /// How many vertices have key >= threshold.
    Index count(double threshold) const;
};

/// Raises keys until no vertex has a smaller one than a vertex that depends on it, and sorts.
/// @param importance  #V by place, >= 0, infinity allowed; that of the base does not matter
/// Cost: linear in the rows' entries, and sorting.
Insertion insertion_order(const Hierarchy& hierarchy, std::vector<double> importance);

/// The first `count` vertices of an order, as a flag per place.
/// @param count  at least the base's size
std::vector<std::uint8_t> inserted(const Insertion& insertion, Index count);

/// The mesh of a closed set, see mesh_of_places().
/// @param in     #V by place, 1 if in the set; closed
/// @param faces  those the hierarchy's rings came from, with input vertex indices
LevelMesh mesh_of_set(const Hierarchy& hierarchy, const Faces& faces, const std::vector<std::uint8_t>& in);

}  // namespace multires
