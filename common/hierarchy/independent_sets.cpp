#include "hierarchy/independent_sets.h"

#include "hierarchy/collapse.h"
#include "mesh/radix_sort.h"
#include "parallel/parallel.h"

#include <algorithm>

#include <limits>

namespace multires {
namespace {

using collapse::Directions;
using collapse::Ring;
using collapse::ring_of;

/// Edges made by the collapses accepted so far in a step, as short lists per collapse target.
class NewEdges {
public:
    explicit NewEdges(Index vertices) : head_(vertices, -1) {}
    void add(Index u, Index w) {
        nodes_.push_back({w, head_[u]});
        head_[u] = static_cast<Index>(nodes_.size()) - 1;
    }
    bool has(Index u, Index w) const { return listed(u, w) || listed(w, u); }

private:
    struct Node {
        Index vertex, next;
    };
    bool listed(Index u, Index w) const {
        for (Index i = head_[u]; i >= 0; i = nodes_[i].next)
            if (nodes_[i].vertex == w) return true;
        return false;
    }
    std::vector<Index> head_;
    std::vector<Node> nodes_;
};

/// The mesh being decimated, in local numbers.
struct State {
    Rings rings;
    Positions positions;
    std::vector<Quadric> quadric;
    std::vector<double>
        error;  ///< quadric[i].c once more: all that is read of a neighbour's, and small enough to stay near
};

/// The cheapest target of every vertex that may go somewhere, and the sort key of its cost.
struct Candidates {
    std::vector<std::uint32_t> key;  ///< all ones: not a candidate
    std::vector<Index> target;       ///< entry in the ring
};

constexpr std::uint32_t never = std::numeric_limits<std::uint32_t>::max();

std::vector<Quadric> vertex_quadrics(const Rings& rings, const Positions& positions, double boundary_weight) {
    std::vector<Quadric> q(rings.rows());
    parallel_for(rings.rows(),
                 [&](Index i) { q[i] = collapse::vertex_quadric(i, ring_of(rings, i), positions, boundary_weight); });
    return q;
}

Candidates rank_vertices(const State& s, double length_weight, int seed) {
    const Index n = s.rings.rows();
    Candidates c;
    c.key.resize(n);
    c.target.resize(n);
    parallel_for(n, [&](Index v) {
        c.key[v] = never;
        const Ring ring = ring_of(s.rings, v);
        const Directions directions(ring);
        if (directions.none()) return;
        double least = std::numeric_limits<double>::infinity();
        for (Index j = 0; j < ring.size; ++j) {
            if (!directions.allows(j)) continue;
            const Index u = ring.vertex[j];
            const double cost =
                collapse::cost(s.quadric[v], s.error[u], s.positions[u] - s.positions[v], length_weight);
            if (cost < least) least = cost, c.target[v] = j;
        }
        if (least < std::numeric_limits<double>::infinity())
            c.key[v] = radix_key(static_cast<float>(least * collapse::jitter(v, seed)));
    });
    return c;
}

/// Picks the odd vertices of one step, cheapest first: takes a vertex, locks its ring, until none is left (Roy et al.
/// 2003, section 3.1).
class Selection {
public:
    Selection(const State& s, const HierarchyOptions& options)
        : s_(s), length_weight_(options.length_weight),
          share_(options.set_share), limits_{std::cos(options.normal_limit_degrees * 3.14159265358979323846 / 180)},
          edges_(s.rings.rows()), degree_(s.rings.rows()), locked_(s.rings.rows(), 0), parent_(s.rings.rows(), -1) {
        for (Index i = 0; i < s.rings.rows(); ++i) degree_[i] = s.rings.size(i);
    }

    void run(const Candidates& candidates, Index most) {
        const std::vector<Index> sorted = sorted_by_key(candidates.key, never);
        const std::size_t last = static_cast<std::size_t>(std::ceil(share_ * static_cast<double>(sorted.size())));
        for (std::size_t i = 0; i < sorted.size(); ++i) {
            if (odd_ >= most || (i >= last && odd_ > 0)) break;
            if (!locked_[sorted[i]]) try_vertex(sorted[i], candidates.target[sorted[i]]);
        }
    }

    Index odd() const { return odd_; }
    std::vector<Index>& parent() { return parent_; }
    const std::vector<Index>& degree() const { return degree_; }  ///< of even vertices: after the step

private:
    void try_vertex(Index v, Index best) {
        const Ring ring = ring_of(s_.rings, v);
        if (allowed(v, ring, best)) return accept(v, ring, best);
        // The cheapest target is barred; try the others in order of cost.
        others_.clear();
        const Directions directions(ring);
        for (Index j = 0; j < ring.size; ++j) {
            if (j == best || !directions.allows(j)) continue;
            const Index u = ring.vertex[j];
            others_.push_back(
                {collapse::cost(s_.quadric[v], s_.error[u], s_.positions[u] - s_.positions[v], length_weight_), j});
        }
        std::sort(others_.begin(), others_.end());
        for (const auto& [cost, j] : others_)
            if (allowed(v, ring, j)) return accept(v, ring, j);
    }

    bool allowed(Index v, const Ring& ring, Index j) const {
        return collapse::link_allows(
                   ring, j, [&](Index i) { return ring_of(s_.rings, i); }, [&](Index i) { return degree_[i]; },
                   [&](Index u, Index w) { return edges_.has(u, w); }) &&
               collapse::faces_stay_good(v, ring.vertex[j], ring, s_.positions, limits_);
    }

    void accept(Index v, const Ring& ring, Index j) {
        const Index u = ring.vertex[j], before = ring.before(j), after = ring.after(j);
        parent_[v] = u;
        locked_[v] = 1;
        ++odd_;
        Index gained = ring.size - 2;
        for (const Index w : {before, after})
            if (w >= 0) --degree_[w], --gained;
        degree_[u] += gained;
        for (Index i = 0; i < ring.size; ++i) {
            const Index w = ring.vertex[i];
            locked_[w] = 1;
            if (w != u && w != before && w != after) edges_.add(u, w);
        }
    }

    const State& s_;
    double length_weight_, share_;
    collapse::FaceLimits limits_;
    NewEdges edges_;
    std::vector<Index> degree_;
    std::vector<std::uint8_t> locked_;
    std::vector<Index> parent_;
    Index odd_ = 0;
    std::vector<std::pair<double, Index>> others_;
};

/// The state after a step: even vertices only, renumbered in their order.
State next_state(const State& s, const Step& step, const std::vector<Index>& degree, const HierarchyOptions& options) {
    const Index n = s.rings.rows(), m = n - step.odd;
    State t;
    t.rings.kind.resize(m);
    t.rings.offset.resize(m + 1);
    t.positions.resize(m);
    t.quadric.resize(m);
    t.error.resize(m);
    const auto parent = [&](Index x) { return step.parent[x]; };
    for (Index i = 0; i < n; ++i)
        if (parent(i) < 0) t.rings.offset[step.rank[i] + 1] = t.rings.offset[step.rank[i]] + degree[i];
    t.rings.neighbor.resize(t.rings.offset[m]);
    if (!s.rings.feature.empty()) t.rings.feature.resize(t.rings.offset[m]);
    const auto ring = [&](Index i) { return ring_of(s.rings, i); };
    parallel_for(n, [&](Index i) {
        if (parent(i) >= 0) return;
        const Index to = step.rank[i];
        t.rings.kind[to] = s.rings.kind[i];
        t.positions[to] = s.positions[i];
        Index at = t.rings.offset[to];
        const Ring old = ring(i);
        collapse::ring_after(i, old, ring, parent, [&](Index x, bool mark) {
            if (!t.rings.feature.empty()) t.rings.feature[at] = mark;
            t.rings.neighbor[at++] = step.rank[x];
        });
        if (options.memoryless) return;
        Quadric q = s.quadric[i];
        for (Index j = 0; j < old.size; ++j) {
            const Index x = old.vertex[j];
            if (parent(x) == i) q.add_moved(s.quadric[x], s.positions[x] - s.positions[i]);
        }
        t.quadric[to] = q;
        t.error[to] = q.c;
    });
    if (options.memoryless) t.quadric = vertex_quadrics(t.rings, t.positions, options.boundary_weight);
    return t;
}

}  // namespace

std::vector<Step> independent_sets(Rings rings, Positions positions, const HierarchyOptions& options,
                                   const Tick& tick) {
    std::vector<Step> steps;
    State s;
    s.quadric = vertex_quadrics(rings, positions, options.boundary_weight);
    s.error.assign(s.quadric.size(), 0);
    s.rings = std::move(rings);
    s.positions = std::move(positions);
    const double whole = static_cast<double>(s.rings.rows());
    const Index stop = options.base_vertices +
                       static_cast<Index>(std::count(s.rings.kind.begin(), s.rings.kind.end(), RingKind::isolated));
    for (;;) {
        const Index n = s.rings.rows();
        if (tick) tick(1 - n / whole);
        Step step;
        std::vector<Index> degree;
        if (n > stop) {
            Selection selection(s, options);
            selection.run(rank_vertices(s, options.length_weight, options.seed), n - stop);
            step.odd = selection.odd();
            step.parent = std::move(selection.parent());
            degree = selection.degree();
        }
        if (step.odd == 0) {
            steps.push_back({std::move(s.rings), std::vector<Index>(n, -1), {}, 0});
            return steps;
        }
        step.rank.resize(n);
        for (Index i = 0, even = 0, odd = 0; i < n; ++i) step.rank[i] = step.parent[i] < 0 ? even++ : odd++;
        State t = next_state(s, step, degree, options);
        step.rings = std::move(s.rings);
        steps.push_back(std::move(step));
        s = std::move(t);
    }
}

}  // namespace multires
