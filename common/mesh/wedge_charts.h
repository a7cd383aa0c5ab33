#pragma once

#include "base/buckets.h"
#include "mesh/layer.h"

namespace multires {

/// The charts of a texture atlas, and the wedge a vertex should get when it takes over a corner of another face.
///
/// A chart is a maximal set of faces connected by corners with one vertex and one wedge. When a half-edge
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
    std::vector<Wedge> corners_;  // 3 #F
    Buckets<Index> around_;       // corners of each vertex
    std::vector<Index> chart_;    // #F
};

/// A face of a level beside the face of the input that it comes from: corner k of the first took the place of corner
/// (k + turn) mod 3 of the second, with the turn that leaves most corners where they were.
struct FacePair {
    Face now, then;  ///< vertices of the input
    int turn = 0;

    FacePair(const Face& of_level, const Face& of_input);
    int place(int k) const { return (k + turn) % 3; }
    bool moved(int k) const { return now[k] != then[place(k)]; }
};

/// A mesh cut open along the seams of its texture atlas, so that every vertex has one texture coordinate: corners that
/// share a vertex and a wedge share a node.
struct CutMesh {
    Mesh mesh;                    ///< #N by 3 positions, #F by 3 nodes; face for face the mesh that was cut
    std::vector<Index> vertex;    ///< #N: vertex of the mesh that was cut
    std::vector<Index> node;      ///< 3 #F: node of corner k of face f at 3 f + k
    std::vector<Index> nodes_of;  ///< #V+1: nodes of vertex i: nodes_of[i] .. nodes_of[i+1]
    std::vector<Wedge> wedge;     ///< #N
};

/// @param wedges  3 #F. Wedges are the same if their numbers are (0 and -0 are) and their textures too.
/// A face that repeats a vertex repeats one node in the cut mesh, so that it counts no more there than it did before;
/// `node` holds its real nodes. Vertices in no face have no node. Cost: O(#F log d) for d faces around a vertex.
CutMesh cut_along_seams(const Mesh& mesh, const std::vector<Wedge>& wedges);

}  // namespace multires
