#pragma once

#include "base/decompositions.h"
#include "base/random.h"
#include "hierarchy/hierarchy.h"
#include "hierarchy/quadric.h"

#include <algorithm>
#include <cmath>

/// What one half-edge collapse v -> u needs and does, shared by the builders. `Mesh` is anything with ring(v) that
/// gives a Ring; rings are those before the collapse.
namespace multires::collapse {

/// One row of Rings.
struct Ring {
    const Index* vertex;
    const std::uint8_t* feature;  ///< null if there are no features
    Index size;
    RingKind kind;

    bool closed() const { return kind == RingKind::closed; }
    bool regular() const { return kind == RingKind::closed || kind == RingKind::open; }
    /// Entry before and after j around the vertex, -1 beyond the end of an open ring.
    Index before(Index j) const { return j > 0 ? vertex[j - 1] : closed() ? vertex[size - 1] : -1; }
    Index after(Index j) const { return j + 1 < size ? vertex[j + 1] : closed() ? vertex[0] : -1; }
    bool marked(Index j) const { return feature && feature[j]; }
    Index find(Index v) const {
        for (Index j = 0; j < size; ++j)
            if (vertex[j] == v) return j;
        return -1;
    }
    int features() const {
        int count = 0;
        if (feature)
            for (Index j = 0; j < size; ++j) count += feature[j] != 0;
        return count;
    }
};

/// Ring r of a CSR table.
inline Ring ring_of(const Rings& rings, Index r) {
    const Index o = rings.offset[r];
    return {rings.neighbor.data() + o, rings.feature.empty() ? nullptr : rings.feature.data() + o, rings.size(r),
            rings.kind[r]};
}

/// Which neighbours v may go to, by its kind alone: along the boundary, along a feature, anywhere, nowhere.
struct Directions {
    explicit Directions(const Ring& ring) : ring_(ring), features_(ring.features()) {}
    bool none() const {
        return !ring_.regular() || (ring_.closed() ? features_ != 0 && features_ != 2 : features_ != 0);
    }
    bool all() const { return ring_.closed() && features_ == 0; }
    bool allows(Index j) const {
        if (!ring_.closed()) return j == 0 || j == ring_.size - 1;
        return features_ == 0 || ring_.marked(j);
    }

private:
    const Ring& ring_;
    int features_;
};

/// Quadric of a vertex: its faces, and for a boundary vertex planes that stand on the boundary edges.
inline Quadric vertex_quadric(Index v, const Ring& ring, const Positions& p, double boundary_weight = 1) {
    Quadric q{};
    if (!ring.regular()) return q;
    const Index triangles = ring.closed() ? ring.size : ring.size - 1;
    for (Index j = 0; j < triangles; ++j) {
        const Vec3 a = p[ring.vertex[j]] - p[v], b = p[ring.after(j)] - p[v], n = a.cross(b);
        const double length = n.norm();
        if (length > 0) q.add_plane(n, length);
        if (ring.closed() || !(length > 0)) continue;
        const auto add_side = [&](const Vec3& edge) {
            const Vec3 side = edge.cross(n);  // |side| = |edge| |n|; the plane counts as |edge|^2
            const double norm = side.norm();
            const double weight = boundary_weight * edge.squaredNorm();
            if (norm > 0) q.add_plane(side * (weight / norm), weight);
        };
        if (j == 0) add_side(a);
        if (j == triangles - 1) add_side(b);
    }
    return q;
}

/// Cost of v -> u: Garland-Heckbert quadrics of both at u, plus the edge-length term.
/// @param target_error  the quadric of u at u
inline double cost(const Quadric& qv, double target_error, const Vec3& d, double length_weight) {
    const double quadric = qv.at(d) + target_error;
    return (quadric > 0 ? quadric : 0) + length_weight * qv.weight() * d.squaredNorm();
}

/// Split::regression_plane: the distance of a vertex from the plane that fits its ring best, or from the line through
/// its two neighbours if it may only go along a curve.
inline double distance_from_ring(Index v, const Ring& ring, const Directions& directions, const Positions& p) {
    Vec3 mean(0, 0, 0);
    Index count = 0;
    const bool curve = !ring.closed() || ring.features() != 0;
    const auto counts = [&](Index j) { return !curve || directions.allows(j); };
    for (Index j = 0; j < ring.size; ++j)
        if (counts(j)) mean += p[ring.vertex[j]], ++count;
    mean /= count;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (Index j = 0; j < ring.size; ++j) {
        const Vec3 d = p[ring.vertex[j]] - mean;
        if (counts(j)) spread += d * d.transpose();
    }
    const Vec3 off = principal_axes_in_closed_form(spread).vectors.transpose() * (p[v] - mean);
    return curve ? off.head(2).norm() : std::abs(off[0]);
}

/// The same criterion's cost of v -> u: the sum of 1 - cos over the turns of the faces that stay (Szczesna 2011, eq.
/// 14). A face that becomes one without a normal counts as turned over.
inline double sum_of_turns(Index v, Index u, const Ring& ring, const Positions& p) {
    const Index triangles = ring.closed() ? ring.size : ring.size - 1;
    double sum = 0;
    for (Index j = 0; j < triangles; ++j) {
        const Index a = ring.vertex[j], b = ring.after(j);
        if (a == u || b == u) continue;
        const Vec3 ab = p[b] - p[a], before = ab.cross(p[v] - p[a]), after = ab.cross(p[u] - p[a]);
        const double squares = before.squaredNorm() * after.squaredNorm();
        if (squares > 0)
            sum += 1 - before.dot(after) / std::sqrt(squares);
        else if (before.squaredNorm() > 0)
            sum += 2;
    }
    return sum;
}

/// Factor in [0.5, 1.5) that varies the order of collapses with the seed; 1 for seed 0.
inline double jitter(Index v, int seed) {
    if (seed == 0) return 1;
    const std::uint64_t number = static_cast<std::uint64_t>(v) << 20 ^ static_cast<std::uint64_t>(seed);
    return 0.5 + unit_interval(scrambled(number * random_step));
}

/// Limits on the faces a collapse leaves behind.
struct FaceLimits {
    double cosine;        ///< of the largest turn of a normal
    double shape = 0.05;  ///< smallest height / longest edge that a face may be given if it was better before
};

/// Checks the faces around v that survive v -> u.
inline bool faces_stay_good(Index v, Index u, const Ring& ring, const Positions& p, const FaceLimits& limits) {
    const Index triangles = ring.closed() ? ring.size : ring.size - 1;
    const Vec3 pv = p[v], pu = p[u];
    for (Index j = 0; j < triangles; ++j) {
        const Index a = ring.vertex[j], b = ring.after(j);
        if (a == u || b == u) continue;
        const Vec3 ab = p[b] - p[a], av = pv - p[a], au = pu - p[a];
        const Vec3 n = ab.cross(av), m = ab.cross(au);
        const double nn = n.squaredNorm(), mm = m.squaredNorm(), nm = n.dot(m), lab = ab.squaredNorm();
        const double longest_before = std::max(lab, std::max(av.squaredNorm(), (pv - p[b]).squaredNorm()));
        const double longest = std::max(lab, std::max(au.squaredNorm(), (pu - p[b]).squaredNorm()));
        const double least = limits.shape * limits.shape;
        const bool sliver_before = nn < least * longest_before * longest_before;
        if (mm < least * longest * longest) {
            // A sliver may stay one, but not become much worse: its tip may move along its short side.
            if (!sliver_before || mm * longest_before * longest_before < 0.9 * nn * longest * longest) return false;
        }
        if (nn < 1e-20 * longest_before * longest_before) continue;  // has no normal to turn
        const double bound = limits.cosine * std::sqrt(nn * mm);
        if (nm < bound) return false;
    }
    return true;
}

/// Rings longer than this are not gone through where a shorter one, or a part, will do.
constexpr Index hub = 32;

/// True if all that is in both rings is found sooner by going through the second.
inline bool is_hub_beside(const Ring& ring, const Ring& other) {
    return ring.size > hub && other.regular() && other.size < ring.size;
}

/// True if w is in the ring of u.
template <class RingOf>
bool in_ring(const RingOf& ring_of, const Ring& ring_of_u, Index u, Index w) {
    if (ring_of_u.size > hub) {  // else the other ring need not be fetched
        const Ring other = ring_of(w);
        if (is_hub_beside(ring_of_u, other)) return other.find(u) >= 0;
    }
    return ring_of_u.find(w) >= 0;
}

/// The link condition for v -> u = ring(v)[j], and that no ring becomes too small. `degree(w)` is the present
/// size of a ring; `joined(u, w)` knows edges made since the rings were taken.
template <class RingOf, class Degree, class Joined>
bool link_allows(const Ring& ring, Index j, const RingOf& ring_of, const Degree& degree, const Joined& joined) {
    const Index u = ring.vertex[j];
    const Ring target = ring_of(u);
    if (!target.regular()) return false;
    if (!ring.closed() && target.closed()) return false;
    const Index wing[2] = {ring.before(j), ring.after(j)};
    Index lost = 1;  // u loses v, and the edges to the wings are shared
    for (const Index w : wing) {
        if (w < 0) continue;
        const Ring r = ring_of(w);
        if (!r.regular() || degree(w) <= (r.closed() ? 3 : 2)) return false;
        ++lost;
    }
    if (degree(u) + ring.size - lost - 1 < (target.closed() ? 3 : 2)) return false;
    for (Index i = 0; i < ring.size; ++i) {
        const Index w = ring.vertex[i];
        if (w == u || w == wing[0] || w == wing[1]) continue;
        if (in_ring(ring_of, target, u, w) || joined(u, w)) return false;
    }
    return true;
}

/// Writes the ring of the even vertex i after all collapses of a step: odd neighbours give way to their parents.
///
/// Three cases for an odd x in i's ring, x -> u: u is i (x's ring takes x's place), u stands beside x (x's place
/// closes up), or u replaces x. Works for any orientation of the two rings.
/// @param odd_parent  parent of an odd vertex, -1 for even ones
/// @param emit        called with (vertex, feature mark) in order around i
template <class RingOf, class OddParent, class Emit>
void ring_after(Index i, const Ring& ring, const RingOf& ring_of, const OddParent& odd_parent, const Emit& emit) {
    for (Index j = 0; j < ring.size; ++j) {
        const Index x = ring.vertex[j];
        const Index u = odd_parent(x);
        if (u < 0) {
            bool mark = ring.marked(j);
            if (ring.feature) {  // a feature edge that merges into this one
                const Index jb = j > 0 ? j - 1 : ring.closed() ? ring.size - 1 : -1;
                const Index ja = j + 1 < ring.size ? j + 1 : ring.closed() ? 0 : -1;
                for (const Index k : {jb, ja}) {
                    const Index y = k >= 0 ? ring.vertex[k] : -1, to = y >= 0 ? odd_parent(y) : -1;
                    if (to == x) mark |= ring.marked(k);
                    if (to == i) mark |= ring_of(y).marked(ring_of(y).find(x));
                }
            }
            emit(x, mark);
        } else if (u == i) {
            const Ring from = ring_of(x);
            const Index t = from.find(i), m = from.size;
            if (from.closed()) {
                const bool same = from.after(t) == ring.before(j);
                for (Index s = 2; s <= m - 2; ++s) {
                    const Index k = (t + (same ? s : m - s)) % m;
                    emit(from.vertex[k], from.marked(k));
                }
            } else {
                // i is an end of x's chain and x an end of i's: the chain goes on beyond the wing.
                const bool first = j == 0;
                for (Index s = 2; s < m; ++s) {
                    const Index step = first ? m + 1 - s : s;
                    const Index k = t == 0 ? step : m - 1 - step;
                    emit(from.vertex[k], from.marked(k));
                }
            }
        } else if (u != ring.before(j) && u != ring.after(j)) {
            emit(u, ring.marked(j));
        }
    }
}

}  // namespace multires::collapse
