#pragma once

#include "mesh/incidence.h"

#include <array>
#include <vector>

namespace multires {

/// Faces that share a vertex or an edge.
struct FaceGraph {
    std::vector<Index> offset{0};             ///< #F+1
    std::vector<Index> neighbor;              ///< faces that share a vertex with it (see below), ascending; not itself
    std::vector<std::array<Index, 2>> edges;  ///< pairs of faces that share an edge, each once, ascending
};

/// Around a vertex with more than 64 faces, such as the middle of a fan, only those within 16 steps over its edges are
/// neighbours of each other, where no step is over an edge of more than 8 faces. Cost: linear.
FaceGraph face_graph(const Faces& faces, const Incidence& at);

}  // namespace multires
