#pragma once

#include "mesh/mesh.h"

#include <array>
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

/// A mesh that grows by vertex splits, with points, normals, and a mark for each face. Half-edge 4f + k leads from
/// corner k of face f to the next. What is known of a face, and of a vertex, is in one line of the cache: going around
/// stars is where the time goes.
///
/// Only regular vertices are split: those whose faces form one fan or disk of one orientation, of at least three faces
/// if it is closed, and of no face with a repeated index. A split leaves all other vertices what they are.
class StarMesh {
public:
    StarMesh() = default;
    /// @param faces  indices below `vertices`; anything goes: whatever is not manifold is not regular
    StarMesh(Index vertices, const Faces& faces);

    Index vertices() const { return static_cast<Index>(vertex_.size()); }
    Index faces() const { return static_cast<Index>(half_.size()); }
    Face face(Index f) const { return half_[f].origin; }
    static Index face_of(Index h) { return h >> 2; }
    bool regular(Index v) const { return vertex_[v].corner >= 0; }
    Index valence(Index v) const { return vertex_[v].valence; }  ///< in faces
    const Vec3& point(Index v) const { return vertex_[v].point; }
    /// Sum of the normals, twice the areas long, of the faces around. Points of whole numbers make sums that are exact:
    /// what is added and taken away again leaves no trace.
    const Vec3& normal(Index v) const { return vertex_[v].normal; }
    /// @param points  #V
    void set_points(const Positions& points);
    Index mark(Index f) const { return half_[f].mark; }  ///< 0 for new faces
    void set_mark(Index f, Index mark) { half_[f].mark = mark; }

    Index origin(Index h) const { return half_[h >> 2].origin[h & 3]; }
    Index target(Index h) const { return origin(next(h)); }
    /// -1 at a boundary or where more than two faces meet.
    Index twin(Index h) const { return half_[h >> 2].twin[h & 3]; }
    // Sums: which corner it is cannot be foreseen, so a branch would cost more.
    static Index next(Index h) { return h + 1 - 3 * static_cast<Index>((h & 3) == 2); }
    static Index previous(Index h) { return h - 1 + 3 * static_cast<Index>((h & 3) == 0); }

    /// The star of a regular vertex.
    void star(Index u, Star& star) const;

    /// Brings a part of the star of a regular vertex into the cache that is soon looked at. What a step asks for should
    /// have come when the next is taken.
    /// @param step  from 0; the sixth face comes with step 7
    /// @param last  what the step before has returned
    Index prefetch(Index u, int step, Index last) const;

    /// Brings the faces beside a star, or the vertices beside them, into the cache.
    void prefetch_faces_beside(const Star& star) const;
    void prefetch_vertices_beside(const Star& star, const Fan& fan) const;

    /// Splits a new vertex, vertices(), off u.
    /// @param star  that of u, regular
    /// @param fan   a fan of it: see allows()
    void split(Index u, const Star& star, const Fan& fan);

    /// Tells the point of the vertex that was split off last; until then the faces around it are in no normal.
    /// @param star  that of v
    void place(Index v, const Star& star, const Vec3& point);

    /// True if there is such a fan.
    static bool allows(const Star& star, const Fan& fan);

private:
    void find_twins();
    void find_corners();
    bool finds_corner(Index v, Index some);
    struct alignas(32) HalfEdges {
        std::array<Index, 3> origin{};
        std::array<Index, 3> twin{-1, -1, -1};
        Index mark = 0;
    };
    struct alignas(64) Vertex {
        Vec3 point{0, 0, 0}, normal{0, 0, 0};
        Index corner = -1;  ///< a half-edge leaving it, the first of an open star; -1: not regular
        Index valence = 0;
    };
    void set_origin(Index h, Index v) { half_[h >> 2].origin[h & 3] = v; }
    void set_twin(Index h, Index twin) { half_[h >> 2].twin[h & 3] = twin; }
    void add_normals(Index u, const Star& star, Index from, Index count, double sign);
    void pair(Index a, Index b);
    Index add_face(Index a, Index b, Index c);
    void split_inside(Index u, const Star& star, const Fan& fan, Index v);
    void split_first(Index u, const Star& star, Index faces, Index v);
    void split_last(Index u, const Star& star, Index faces, Index v);
    void set_corner(Index v, Index h) {
        if (vertex_[v].corner >= 0) vertex_[v].corner = h;
    }

    std::vector<HalfEdges> half_;  ///< #F
    std::vector<Vertex> vertex_;   ///< #V
};

}  // namespace multires::stream
