#pragma once

#include "mesh/incidence.h"

#include <array>
#include <vector>

namespace multires {

/// Faces that share a vertex or an edge.
struct FaceGraph {
    std::vector<Index> offset{0};             ///< #F+1
    std::vector<Index> neighbor;              ///< faces that share a vertex with it, ascending; not itself
    std::vector<std::array<Index, 2>> edges;  ///< pairs of faces that share an edge, each once, ascending
};

/// Cost: linear for bounded valences; faces around a vertex of valence d have d neighbours each.
FaceGraph face_graph(const Faces& faces, const Incidence& at);

}  // namespace multires
