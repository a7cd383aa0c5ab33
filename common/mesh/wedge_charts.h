#pragma once

#include "mesh/layer.h"

namespace multires {

/// The charts of a texture atlas, and the wedge a vertex should get when it takes over a corner of another face.
///
/// A chart is a largest set of faces that hang together at corners with one vertex and one wedge. When a half-edge
/// collapse moves corner k of a face from vertex u to vertex v, the face keeps its place in the atlas: of the wedges
/// that v has in the face's own chart, the one nearest in (u, v) to the old corner's is taken. Where v has none
/// there, the corner keeps the wedge it has: a little stretch instead of a triangle that spans the atlas.
class WedgeCharts {
public:
    /// \param vertices  number of vertices the faces may refer to
    /// \param faces     #F by 3
    /// \param corners   3 #F, corner k of face f at 3 f + k
    /// Cost: O(#F log d) for the largest number d of faces around a vertex.
    WedgeCharts(Index vertices, const Faces& faces, std::vector<Wedge> corners);

    /// The wedge of `vertex` where it takes the place of corner k of `face`. Cost: O(faces around the vertex).
    const Wedge& wedge(Index vertex, Index face, int k) const;

private:
    std::vector<Wedge> corners_;         // 3 #F
    std::vector<Index> first_, around_;  // corners around vertex i: around_[first_[i] .. first_[i+1])
    std::vector<Index> chart_;           // #F
};

}  // namespace multires
