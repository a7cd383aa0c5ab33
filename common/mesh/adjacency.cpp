#include "mesh/adjacency.h"

#include "base/angles.h"
#include "base/buckets.h"
#include "base/parallel.h"
#include "base/reduce.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// The two other corners of a face, seen from one corner, in the face's orientation.
struct RingEdge {
    Index from, to;
};

Buckets<RingEdge> wedges_by_vertex(const Mesh& mesh) {
    const std::size_t faces = mesh.faces.size();
    const int parts = faces < 8192 ? 1 : std::min(thread_count(), 4);
    const auto visit = [&](Index part, const auto& put) {
        for (std::size_t f = faces * part / parts; f < faces * (part + 1) / parts; ++f) {
            const Face& face = mesh.faces[f];
            if (!repeats_an_index(face))
                for (int k = 0; k < 3; ++k) put(face[k], RingEdge{face[(k + 1) % 3], face[(k + 2) % 3]});
        }
    };
    return Buckets<RingEdge>::in_parts(static_cast<Index>(mesh.positions.size()), parts, visit);
}

/// Chains the wedges of one vertex into a ring, ordering them in place; gives what the neighbourhood is.
///
/// Works on unordered wedges so that inconsistent orientation does no harm, but follows the orientation of the first
/// wedge that starts the ring.
class Chainer {
public:
    RingKind chain(RingEdge* wedges, Index count) {
        if (count == 0) return RingKind::isolated;
        return chain_oriented(wedges, count) ? kind_of(wedges, count) : chain_unoriented(wedges, count);
    }

private:
    /// The common case, consistent orientation and small valence: follow `from` to `to`, in place.
    static bool chain_oriented(RingEdge* w, Index n) {
        if (n > 32) return false;
        Index first = 0;  // a wedge whose `from` is no other's `to` starts an open ring
        for (Index i = 0; i < n; ++i) {
            bool entered = false;
            for (Index j = 0; j < n; ++j) {
                if (j != i && w[j].from == w[i].from) return false;
                entered |= w[j].to == w[i].from;
            }
            if (!entered) first = i;
        }
        std::swap(w[0], w[first]);
        for (Index i = 1; i < n; ++i) {
            Index j = i;
            while (j < n && w[j].from != w[i - 1].to) ++j;
            if (j == n) return false;
            std::swap(w[i], w[j]);
        }
        for (Index i = 1; i < n; ++i)
            if (w[i].from == w[n - 1].to) return false;  // runs into its own middle: an edge with three faces
        return true;
    }

    static RingKind kind_of(const RingEdge* w, Index n) {
        if (w[n - 1].to != w[0].from) return RingKind::open;
        return n >= 3 ? RingKind::closed : RingKind::irregular;
    }

    /// Any orientation and valence: sort the wedge ends, then walk from wedge to wedge over shared neighbours.
    RingKind chain_unoriented(RingEdge* w, Index n) {
        ends_.clear();
        for (Index i = 0; i < n; ++i) {
            ends_.push_back({w[i].from, i});
            ends_.push_back({w[i].to, i});
        }
        std::sort(ends_.begin(), ends_.end());
        Index start = 0;
        bool open = false;
        for (std::size_t i = 0; i < ends_.size();) {
            std::size_t j = i;
            while (j < ends_.size() && ends_[j].first == ends_[i].first) ++j;
            if (j - i > 2) return RingKind::irregular;  // an edge with more than two faces
            // Of the two ends of an open ring, start at the one its wedge leaves from.
            if (j - i == 1 && (!open || w[ends_[i].second].from == ends_[i].first)) {
                start = ends_[i].second;
                open = true;
            }
            i = j;
        }
        out_.clear();
        RingEdge current = w[start];
        if (open && mates(current.from) != 1) std::swap(current.from, current.to);
        const Index begin = current.from;
        Index at = start;
        for (Index step = 0; step < n; ++step) {
            out_.push_back(current);
            const Index next = other(current.to, at);
            if (next < 0) break;
            at = next;
            const Index shared = current.to;
            current = w[next].from == shared ? w[next] : RingEdge{w[next].to, w[next].from};
            if (!open && shared == begin) break;
        }
        if (static_cast<Index>(out_.size()) != n) return RingKind::irregular;  // more than one fan
        std::copy(out_.begin(), out_.end(), w);
        return kind_of(w, n);
    }

    Index mates(Index neighbor) const {
        const auto at = std::lower_bound(ends_.begin(), ends_.end(), std::pair<Index, Index>(neighbor, -1));
        Index count = 0;
        for (auto i = at; i != ends_.end() && i->first == neighbor; ++i) ++count;
        return count;
    }

    /// The other wedge that ends at the neighbour, -1 if none.
    Index other(Index neighbor, Index wedge) const {
        auto i = std::lower_bound(ends_.begin(), ends_.end(), std::pair<Index, Index>(neighbor, -1));
        for (; i != ends_.end() && i->first == neighbor; ++i)
            if (i->second != wedge) return i->second;
        return -1;
    }

    std::vector<std::pair<Index, Index>> ends_;  // (neighbour, wedge)
    std::vector<RingEdge> out_;
};

/// Moves wedges with the ends of one before them to the end; gives how many there are without them.
Index without_duplicates(RingEdge* w, Index count) {
    const auto ends = [](const RingEdge& e) { return std::minmax(e.from, e.to); };
    std::sort(w, w + count, [&](const RingEdge& a, const RingEdge& b) { return ends(a) < ends(b); });
    return static_cast<Index>(
        std::unique(w, w + count, [&](const RingEdge& a, const RingEdge& b) { return ends(a) == ends(b); }) - w);
}

/// @param surface  duplicate faces do not count
Rings rings_of(const Mesh& mesh, bool surface) {
    Buckets<RingEdge> wedges = wedges_by_vertex(mesh);
    const Index n = static_cast<Index>(mesh.positions.size());
    Rings rings;
    rings.kind.resize(n);
    rings.offset.resize(n + 1);
    rings.offset[0] = 0;
    parallel_chunks(n, 256, [&](Index begin, Index end) {
        Chainer chainer;
        for (Index i = begin; i < end; ++i) {
            RingEdge* const w = wedges[i].begin();
            Index count = wedges[i].size();
            RingKind& kind = rings.kind[i];
            kind = chainer.chain(w, count);
            if (surface && kind == RingKind::irregular) {
                count = without_duplicates(w, count);
                if (count < wedges[i].size()) kind = chainer.chain(w, count);
            }
            const bool has_ring = kind == RingKind::closed || kind == RingKind::open;
            rings.offset[i + 1] = has_ring ? count + (kind == RingKind::open) : 0;
        }
    });
    add_up(rings.offset);
    rings.neighbor.resize(rings.offset[n]);
    parallel_for(n, [&](Index i) {
        const auto w = wedges[i];
        Index* out = rings.neighbor.data() + rings.offset[i];
        const Index d = rings.size(i), wedge_count = rings.kind[i] == RingKind::open ? d - 1 : d;
        for (Index j = 0; j < d; ++j) out[j] = j < wedge_count ? w[j].from : w[j - 1].to;
    });
    return rings;
}

/// Where the neighbour stands in a row, -1 if not.
Index find_in(const Rings& rings, Index row, Index neighbor) {
    const Index* r = rings.begin(row);
    for (Index j = 0; j < rings.size(row); ++j)
        if (r[j] == neighbor) return j;
    return -1;
}

/// The neighbour of `a` beside `b` in a's ring that is not `not_this`, -1 if there is none or if the edge {a, b} is a
/// feature, which no second-order difference crosses.
Index beside(const Rings& rings, Index a, Index b, Index not_this) {
    const Index j = find_in(rings, a, b), d = rings.size(a);
    if (j < 0 || (!rings.feature.empty() && rings.feature[rings.offset[a] + j])) return -1;
    const Index* r = rings.begin(a);
    const bool closed = rings.kind[a] == RingKind::closed;
    const Index before = j > 0 ? r[j - 1] : closed ? r[d - 1] : -1;
    const Index after = j + 1 < d ? r[j + 1] : closed ? r[0] : -1;
    return before == not_this ? after : before;
}

/// The flap of the link from entry j of a closed row i to the next, that entry itself if there is none.
Index flap_of(const Rings& rings, Index i, Index j) {
    const Index d = rings.size(i), a = rings.begin(i)[j];
    const Index b = rings.begin(i)[j + 1 < d ? j + 1 : 0];
    const Index flap = rings.size(a) > 0 ? beside(rings, a, b, i) : beside(rings, b, a, i);
    return flap >= 0 ? flap : a;
}

}  // namespace

Rings vertex_rings(const Mesh& mesh) { return rings_of(mesh, false); }

Rings surface_rings(const Mesh& mesh) { return rings_of(mesh, true); }

Index next_on_boundary(const Rings& rings, Index from, Index at) {
    const Index d = rings.size(at), none = at;
    if (rings.kind[at] != RingKind::open) return none;
    if (!rings.feature.empty()) {
        const std::uint8_t* const feature = rings.feature.data() + rings.offset[at];
        if (std::any_of(feature + 1, feature + d - 1, [](auto f) { return f != 0; })) return none;
    }
    const Index first = rings.begin(at)[0], last = rings.begin(at)[d - 1];
    return first == from ? last : last == from ? first : none;
}

void find_flaps(Rings& rings) {
    rings.flap.resize(rings.neighbor.size());
    parallel_for(rings.rows(), [&](Index i) { find_flaps(rings, i, rings.flap.data() + rings.offset[i]); });
}

void find_flaps(const Rings& rings, Index i, Index* flap) {
    const Index d = rings.size(i);
    const Index* const r = rings.begin(i);
    if (rings.kind[i] != RingKind::closed || !rings.feature.empty()) {
        const bool open = rings.kind[i] == RingKind::open;
        for (Index j = 0; j < d; ++j) flap[j] = open ? r[j] : flap_of(rings, i, j);
        for (Index j = 0; open && j < d; j += d - 1) flap[j] = next_on_boundary(rings, i, r[j]);
        return;
    }
    // In the ring of neighbour j, i stands between j-1 and j+1, and beyond those are the flaps of both links: one
    // search for two.
    for (Index j = d % 2; j < d + d % 2; j += 2) {
        const Index at_j = j < d ? j : 0, before = at_j > 0 ? at_j - 1 : d - 1, after = at_j + 1 < d ? at_j + 1 : 0;
        const Index a = r[at_j], n = rings.size(a), at = find_in(rings, a, i);
        if (at < 0 || rings.kind[a] != RingKind::closed) {
            flap[before] = flap_of(rings, i, before);
            flap[at_j] = flap_of(rings, i, at_j);
            continue;
        }
        const Index* const around = rings.begin(a);
        const auto entry = [&](Index k) { return around[k < 0 ? k + n : k < n ? k : k - n]; };
        const bool along = entry(at + 1) == r[after];
        flap[at_j] = entry(along ? at + 2 : at - 2);
        flap[before] = entry(along ? at - 2 : at + 2);
    }
}

void mark_features_by_angle(Rings& rings, const Positions& positions, double degrees) {
    const double limit = std::cos(radians(degrees));
    if (rings.feature.empty()) rings.feature.assign(rings.neighbor.size(), 0);
    const auto sharp = [&](Index i, Index j) {
        const Index d = rings.size(i);
        const bool closed = rings.kind[i] == RingKind::closed;
        if (!closed && (j == 0 || j == d - 1)) return false;
        const Index* r = rings.begin(i);
        const Vec3 p = positions[i], spoke = positions[r[j]] - p;
        const Vec3 n = (positions[r[(j + d - 1) % d]] - p).cross(spoke);
        const Vec3 m = spoke.cross(positions[r[(j + 1) % d]] - p);
        const double size = n.norm() * m.norm();
        return size > 0 && n.dot(m) < limit * size;
    };
    // Both ends must agree to the last bit, so the angle is computed at one of them.
    parallel_for(rings.rows(), [&](Index i) {
        for (Index j = 0; j < rings.size(i); ++j) {
            const Index other = rings.begin(i)[j];
            const bool here = i < other || rings.size(other) == 0;
            rings.feature[rings.offset[i] + j] |= here ? sharp(i, j) : sharp(other, find_in(rings, other, i));
        }
    });
}

void mark_features(Rings& rings, const Faces& faces, const std::vector<std::uint8_t>& edges) {
    if (rings.feature.empty()) rings.feature.assign(rings.neighbor.size(), 0);
    const auto mark = [&](Index a, Index b) {
        const Index j = find_in(rings, a, b);
        if (j < 0) return;
        const bool end = rings.kind[a] == RingKind::open && (j == 0 || j == rings.size(a) - 1);
        if (!end) rings.feature[rings.offset[a] + j] = 1;
    };
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k)
            if (edges[f] >> k & 1) {
                mark(faces[f][k], faces[f][(k + 1) % 3]);
                mark(faces[f][(k + 1) % 3], faces[f][k]);
            }
}

Array<Index> breadth_first_order(const Rings& rings) {
    const Index n = rings.rows();
    Array<Index> order;
    order.reserve(n);
    std::vector<std::uint8_t> seen(n, 0);
    const auto visit = [&](Index v) {
        if (!seen[v]) seen[v] = 1, order.push_back(v);
    };
    for (Index start = 0; start < n; ++start) {
        std::size_t at = order.size();
        for (visit(start); at < order.size(); ++at) {
            const Index v = order[at];
            for (Index j = 0; j < rings.size(v); ++j) visit(rings.begin(v)[j]);
        }
    }
    return order;
}

}  // namespace multires
