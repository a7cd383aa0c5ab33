#include "base/buckets.h"
#include "random.h"
#include "shapes.h"

#include <algorithm>

namespace multires::shapes {

namespace {

/// Corner table of an oriented manifold mesh with boundary. Half-edge 3 f + k runs from corner k of face f to the next.
class CornerTable {
public:
    explicit CornerTable(Mesh& mesh)
        : mesh_(mesh), opposite_(3 * mesh.faces.size(), -1), valence_(mesh.positions.size(), 0) {
        for (Index h = 0; h < half_edges(); ++h) ++valence_[tail(h)];
        const Buckets<Index> by_smaller_end(static_cast<Index>(mesh.positions.size()), half_edges(),
                                            [&](Index h) { return std::min(tail(h), head(h)); });
        for (Index v = 0; v < by_smaller_end.size(); ++v) match(by_smaller_end[v].begin(), by_smaller_end[v].end());
    }

    Index half_edges() const { return static_cast<Index>(opposite_.size()); }

    /// Turns the diagonal of the two faces at half-edge h if that is allowed.
    bool flip(Index h) {
        const Index g = opposite_[h];
        if (g < 0) return false;
        const Index a = tail(h), b = head(h), c = tail(previous(h)), d = tail(previous(g));
        if (valence_[a] < 5 || valence_[b] < 5 || c == d || connected(previous(h), d) || !keeps_shape(a, b, c, d))
            return false;
        const Index bc = opposite_[next(h)], ca = opposite_[previous(h)];
        const Index ad = opposite_[next(g)], db = opposite_[previous(g)];
        const Index f = h / 3 * 3, e = g / 3 * 3;
        mesh_.faces[h / 3] = {a, d, c};
        mesh_.faces[g / 3] = {d, b, c};
        pair(f, ad);
        pair(f + 1, e + 2);
        pair(f + 2, ca);
        pair(e, db);
        pair(e + 1, bc);
        --valence_[a];
        --valence_[b];
        ++valence_[c];
        ++valence_[d];
        return true;
    }

private:
    static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
    Index tail(Index h) const { return mesh_.faces[h / 3][h % 3]; }
    Index head(Index h) const { return mesh_.faces[h / 3][(h % 3 + 1) % 3]; }

    void pair(Index h, Index g) {
        opposite_[h] = g;
        if (g >= 0) opposite_[g] = h;
    }

    /// Pairs the half-edges of one bucket (same smaller vertex) that are alone in running back along each other.
    void match(const Index* begin, const Index* end) {
        for (const Index* h = begin; h != end; ++h) {
            Index partner = -1, users = 0;
            for (const Index* g = begin; g != end; ++g) {
                if (std::max(tail(*g), head(*g)) != std::max(tail(*h), head(*h))) continue;
                ++users;
                if (tail(*g) == head(*h)) partner = *g;
            }
            if (users == 2 && partner >= 0) opposite_[*h] = partner;
        }
    }

    /// True if an edge joins the tail of `start` and d, or if the tail lies on the boundary (and so not all is seen).
    bool connected(Index start, Index d) const {
        Index h = start;
        do {
            if (head(h) == d || tail(previous(h)) == d) return true;
            h = opposite_[previous(h)];
        } while (h >= 0 && h != start);
        return h < 0;
    }

    /// The new triangles' normals are within 60 degrees of the old ones' and their angles at least 10 degrees.
    bool keeps_shape(Index a, Index b, Index c, Index d) const {
        const auto& p = mesh_.positions;
        const Vec3 old1 = (p[b] - p[a]).cross(p[c] - p[a]), old2 = (p[a] - p[b]).cross(p[d] - p[b]);
        const Vec3 new1 = (p[d] - p[a]).cross(p[c] - p[a]), new2 = (p[b] - p[d]).cross(p[c] - p[d]);
        for (const Vec3* o : {&old1, &old2}) {
            for (const Vec3* n : {&new1, &new2}) {
                if (n->dot(*o) < 0.5 * n->norm() * o->norm()) return false;
            }
        }
        return least_sine(p[a], p[d], p[c]) > 0.17 && least_sine(p[d], p[b], p[c]) > 0.17;
    }

    /// Sine of the smallest angle of a triangle: 2 area / product of the two longest sides.
    static double least_sine(const Vec3& a, const Vec3& b, const Vec3& c) {
        const double x = (b - a).norm(), y = (c - b).norm(), z = (a - c).norm(), least = std::min({x, y, z});
        return (b - a).cross(c - a).norm() * least / (x * y * z);
    }

    Mesh& mesh_;
    std::vector<Index> opposite_, valence_;
};

}  // namespace

void flip_edges(Mesh& mesh, double fraction, std::uint64_t seed) {
    if (fraction <= 0) return;
    CornerTable corners(mesh);
    Random random(seed);
    for (Index h = 0; h < corners.half_edges(); ++h) {
        if (random.chance(fraction / 2)) corners.flip(h);  // each edge comes up twice
    }
}

}  // namespace multires::shapes
