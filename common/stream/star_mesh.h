#pragma once

#include "mesh/mesh.h"

#include <vector>

namespace multires::stream {

/// A fan of the star of a vertex u, and the vertex v that is to be split off it: the inverse of a half-edge collapse
/// v -> u. The faces of the fan become v's, and new faces fill the gap.
struct Fan {
    enum Kind { inside, first, last };  ///< v inside the surface; or on the boundary, at the star's first or last edge
    Kind kind = inside;
    Index start = 0;  ///< the first of the fan's faces, counted around u
    Index faces = 0;  ///< inside: at least 1
};

/// The faces around a vertex u. Face i is (u, spoke i, spoke i + 1), in counter-clockwise order; a closed star's last
/// spoke is its first.
struct Star {
    std::vector<Index> leaving;  ///< the half-edges u -> spoke i, one a face
    std::vector<Index> spoke;    ///< vertices, one more than faces
    bool closed = false;

    Index faces() const { return static_cast<Index>(leaving.size()); }
};

/// A mesh that grows by vertex splits. Half-edge 3f + k leads from corner k of face f to the next.
///
/// Only regular vertices are split: those whose faces form one fan or disk of one orientation, of at least three faces
/// if it is closed, and of no face with a repeated index. A split leaves all other vertices what they are.
class StarMesh {
public:
    StarMesh() = default;
    /// @param faces  indices below `vertices`; anything goes: whatever is not manifold is not regular
    StarMesh(Index vertices, const Faces& faces);

    Index vertices() const { return static_cast<Index>(corner_.size()); }
    Index faces() const { return static_cast<Index>(origin_.size()) / 3; }
    Face face(Index f) const { return {origin_[3 * f], origin_[3 * f + 1], origin_[3 * f + 2]}; }
    bool regular(Index v) const { return corner_[v] >= 0; }
    Index valence(Index v) const { return valence_[v]; }  ///< in faces

    Index origin(Index h) const { return origin_[h]; }
    Index target(Index h) const { return origin(next(h)); }
    Index twin(Index h) const { return twin_[h]; }  ///< -1 at a boundary or where more than two faces meet
    static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }

    /// The star of a regular vertex.
    void star(Index u, Star& star) const;

    /// Splits a new vertex, vertices(), off u.
    /// @param star  that of u, regular
    /// @param fan   a fan of it: see allows()
    void split(Index u, const Star& star, const Fan& fan);

    /// True if there is such a fan.
    static bool allows(const Star& star, const Fan& fan);

private:
    void find_twins();
    void find_corners();
    bool finds_corner(Index v, Index some);
    void pair(Index a, Index b);
    Index add_face(Index a, Index b, Index c);
    void split_inside(Index u, const Star& star, const Fan& fan, Index v);
    void split_first(Index u, const Star& star, Index faces, Index v);
    void split_last(Index u, const Star& star, Index faces, Index v);
    void set_corner(Index v, Index h) {
        if (corner_[v] >= 0) corner_[v] = h;
    }

    std::vector<Index> origin_;   ///< #F by 3: the faces
    std::vector<Index> twin_;     ///< #F by 3
    std::vector<Index> corner_;   ///< #V: a half-edge leaving the vertex, the first of an open star; -1: not regular
    std::vector<Index> valence_;  ///< #V
};

}  // namespace multires::stream
