#pragma once

#include "base/buckets.h"
#include "mesh/mesh.h"

#include <algorithm>

namespace multires {

/// Faces of each vertex, ascending; a face that repeats a vertex comes as often.
using Incidence = Buckets<Index>;

/// @param vertices  #V; face indices are in range
/// Cost: linear.
Incidence vertex_faces(const Faces& faces, Index vertices);

/// Calls with(face) for the faces that share the edge of face f across from its vertex v, but not v.
template <class With>
void for_faces_across(const Faces& faces, const Incidence& at, Index f, Index v, const With& with) {
    Index edge[2], found = 0;
    for (const Index w : faces[f])
        if (w != v && found < 2) edge[found++] = w;
    if (found < 2 || edge[0] == edge[1]) return;
    for (const Index h : at[edge[0]]) {
        const Face& g = faces[h];
        if (std::find(g.begin(), g.end(), edge[1]) != g.end() && std::find(g.begin(), g.end(), v) == g.end()) with(g);
    }
}

}  // namespace multires
