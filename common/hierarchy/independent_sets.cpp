#include "hierarchy/independent_sets.h"

#include "base/angles.h"
#include "base/parallel.h"
#include "base/radix_sort.h"
#include "base/reduce.h"
#include "hierarchy/collapse.h"
#include "hierarchy/fresh_costs.h"
#include "hierarchy/placement.h"
#include "mesh/corner.h"

#include <algorithm>
#include <array>
#include <limits>

namespace multires {
namespace {

using collapse::Directions;
using collapse::Ring;
using collapse::ring_of;

/// The mesh being decimated, in local numbers.
struct State {
    Rings rings;
    Positions positions;
    Array<Quadric> quadric;  ///< none if costs are memoryless
    Array<double> error;  ///< quadric[i].c once more: all that is read of a neighbour's, and small enough to stay near
};

/// The cheapest target of every vertex that may go somewhere, and the sort key of its cost.
struct Candidates {
    Array<std::uint32_t> key;  ///< all ones: not a candidate
    Array<Index> target;       ///< entry in the ring
};

/// How much a step may take.
struct Budget {
    Index vertices, faces;

    bool spent() const { return vertices <= 0 || faces <= 0; }
};

constexpr Index no_limit = std::numeric_limits<Index>::max();

constexpr std::uint32_t never = std::numeric_limits<std::uint32_t>::max();

Array<Quadric> vertex_quadrics(const Rings& rings, const Positions& positions, double boundary_weight) {
    Array<Quadric> q(rings.rows());
    parallel_for(rings.rows(),
                 [&](Index i) { q[i] = collapse::vertex_quadric(i, ring_of(rings, i), positions, boundary_weight); });
    return q;
}

/// The costs of v -> ring(v)[j], which decide between targets.
class Costs {
public:
    Costs(const State& s, Index v, const Ring& ring, const HierarchyOptions& options)
        : s_(s), v_(v), ring_(ring), options_(options) {
        if (options.split != Split::quadric) return;
        quadric_ =
            options.memoryless ? collapse::vertex_quadric(v, ring, s.positions, options.boundary_weight) : s.quadric[v];
    }

    double operator[](Index j) const {
        const Index u = ring_.vertex[j];
        if (options_.split == Split::regression_plane) return collapse::sum_of_turns(v_, u, ring_, s_.positions);
        const double target_error = options_.memoryless ? 0 : s_.error[u];
        return collapse::cost(quadric_, target_error, s_.positions[u] - s_.positions[v_], options_.length_weight);
    }

private:
    const State& s_;
    Index v_;
    const Ring& ring_;
    const HierarchyOptions& options_;
    Quadric quadric_{};
};

/// True if the boundary at v is coarser than the surface beside it: it waits until that has caught up, or its details
/// would be those of longer waves than the others of their level. (Where a scan was cut off, edges are often longer.)
/// Only neighbours inside count: the two sides of a strip wait for nothing.
bool boundary_runs_ahead(const State& s, Index v, const Ring& ring) {
    if (ring.closed()) return false;
    const auto length = [&](Index j) { return (s.positions[ring.vertex[j]] - s.positions[v]).norm(); };
    double inner = 0;
    int count = 0;
    for (Index j = 1; j + 1 < ring.size; ++j)
        if (s.rings.kind[ring.vertex[j]] == RingKind::closed) inner += length(j), ++count;
    return count > 0 && (length(0) + length(ring.size - 1)) / 2 > 1.5 * inner / count;
}

/// True at a corner of the boundary that points outwards: without it the outline would be another one. There are few of
/// them at any level, for on both sides the boundary must go straight on for two edges.
bool is_corner(const State& s, Index v, const Ring& ring) {
    if (ring.closed()) return false;
    const Vec3& at = s.positions[v];
    Vec3 to[2], step[2], inside = Vec3::Zero();
    for (int end = 0; end < 2; ++end) {
        const Index beside = ring.vertex[end == 0 ? 0 : ring.size - 1];
        const Ring on = ring_of(s.rings, beside);
        if (on.kind != RingKind::open) return false;
        const Index first = on.vertex[0], next = first == v ? on.vertex[on.size - 1] : first;
        to[end] = s.positions[beside] - at, step[end] = s.positions[next] - s.positions[beside];
    }
    for (Index j = 1; j + 1 < ring.size; ++j) inside += s.positions[ring.vertex[j]] - at;
    return inside.dot(to[0] + to[1]) >= 0 &&
           corner_share(turn(-to[0], to[1]), std::max(turn(to[0], step[0]), turn(to[1], step[1]))) > 0.5;
}

Candidates rank_vertices(const State& s, const HierarchyOptions& options) {
    const Index n = s.rings.rows();
    Candidates c;
    c.key.resize(n);
    c.target.resize(n);
    const bool fresh = options.split == Split::quadric && options.memoryless;
    const bool levels_are_even = options.length_weight > 0 && !options.memoryless;
    parallel_for(n, [&](Index v) {
        c.key[v] = never;
        const Ring ring = ring_of(s.rings, v);
        const Directions directions(ring);
        if (directions.none()) return;
        if (levels_are_even && (boundary_runs_ahead(s, v, ring) || is_corner(s, v, ring))) return;
        double least = std::numeric_limits<double>::infinity();
        if (fresh && collapse::FreshCosts::takes(ring) && directions.all()) {
            const collapse::FreshCosts costs(v, ring, s.positions, options.length_weight);
            c.target[v] = costs.cheapest();
            least = costs[c.target[v]];
        } else {
            const Costs costs(s, v, ring, options);
            Index best = 0;
            const bool all = directions.all();
            for (Index j = 0; j < ring.size; ++j) {
                if (!all && !directions.allows(j)) continue;
                const double cost = costs[j];  // which is less is hard to predict: no branch
                best = cost < least ? j : best;
                least = cost < least ? cost : least;
            }
            c.target[v] = best;
        }
        if (!(least < std::numeric_limits<double>::infinity())) return;
        if (options.split == Split::regression_plane)
            least = collapse::distance_from_ring(v, ring, directions, s.positions);
        for (int i = 0; i < options.valence_power; ++i) least *= ring.size / 6.0;
        c.key[v] = radix_key(static_cast<float>(least * collapse::jitter(v, options.seed)));
    });
    return c;
}

/// Picks the odd vertices of one step, cheapest first: takes a vertex, locks its ring, until none is left (Roy et al.
/// 2003, section 3.1).
///
/// Parts of the vertices are picked at the same time: whatever a vertex needs to know lies in its ring and beside it,
/// so those whose ring lies in their own part cannot meet another part's. The others are picked afterwards. The parts
/// are ranges of indices whose number depends on the mesh alone; every other step they lie half a part further, so
/// that their seams leave no trace in the levels.
class Selection {
public:
    /// No collapse costs more than the step's limit: none to another target than the cheapest, either, if that is
    /// barred.
    /// @param strict  not even if hardly any may be taken
    Selection(const State& s, const HierarchyOptions& options, bool strict)
        : s_(s), options_(options), share_(options.set_share),
          strict_(strict), limits_{std::cos(radians(options.normal_limit_degrees))}, degree_(s.rings.rows()),
          state_(s.rings.rows(), free), parent_(s.rings.rows(), -1) {
        parallel_for(s.rings.rows(), [&](Index i) { degree_[i] = s.rings.size(i); });
    }

    void run(const Candidates& candidates, Budget most, bool shifted) {
        const Index n = s_.rings.rows();
        const std::uint32_t limit = share_ < 1 ? key_of_share(candidates.key) : never;
        most_of_others_ = limit;
        // Only large meshes are cut, where `most` is far away.
        const bool far = most.vertices > n / 2 && most.faces > n;
        const Index parts = far ? std::clamp<Index>(n / least_part, 1, most_parts) : 1;
        const Index width = (n - 1) / parts + 1, shift = parts > 1 && shifted ? width / 2 : 0;
        std::vector<std::vector<Index>> seams(parts + 1);
        std::vector<Index> odd(parts + 1, 0);
        parallel_for(
            parts + 1,
            [&](Index part) {
                const Index begin = std::max<Index>(0, part * width - shift);
                const Index end = std::min(n, (part + 1) * width - shift);
                odd[part] = pick(sorted_inside(begin, end, candidates, limit, seams[part]), candidates, limit, most);
            },
            1);
        for (const Index count : odd) odd_ += count;
        most.vertices -= odd_;
        if (most.faces != no_limit) most.faces -= faces_taken();
        std::vector<Index> rest;
        for (const std::vector<Index>& seam : seams)
            for (const Index v : seam)
                if (state_[v] == free) rest.push_back(v);
        const Index odd_in_seams = pick(sorted_by_key(std::move(rest), candidates.key), candidates, limit, most);
        odd_ += odd_in_seams;
        if (limit != never && !strict_) take_more(candidates, {most.vertices - odd_in_seams, most.faces}, limit);
    }

    Index odd() const { return odd_; }
    const Array<Index>& parent() const { return parent_; }  ///< -1: even
    const Array<Index>& degree() const { return degree_; }  ///< of even vertices: after the step

    /// How many faces the collapses so far take away.
    Index faces_taken() const {
        Index faces = 0;
        for (Index v = 0; v < s_.rings.rows(); ++v)
            if (parent_[v] >= 0) faces += faces_of(v);
        return faces;
    }

private:
    enum : std::uint8_t { free = 0, locked = 1, target = 2 };
    static constexpr Index least_part = 8192, most_parts = 16;

    /// The candidates of a range up to a cost, in order of cost; those whose rings leave it go to `seam`.
    std::vector<Index> sorted_inside(Index begin, Index end, const Candidates& c, std::uint32_t limit,
                                     std::vector<Index>& seam) const {
        const bool whole = begin == 0 && end == s_.rings.rows();
        std::vector<Index> inside;
        for (Index v = begin; v < end; ++v) {
            if (c.key[v] == never || c.key[v] > limit) continue;
            const auto in = [&](Index w) { return w >= begin && w < end; };
            const Index* const ring = s_.rings.begin(v);
            (whole || std::all_of(ring, ring + s_.rings.size(v), in) ? inside : seam).push_back(v);
        }
        return sorted_by_key(std::move(inside), c.key);
    }

    /// Where too few of the share may go to their cheapest targets: they may go to others. If none may, whichever is
    /// the first to may.
    void take_more(const Candidates& candidates, Budget most, std::uint32_t limit) {
        if (64 * odd_ >= s_.rings.rows()) return;
        most_of_others_ = never;
        const std::vector<Index> sorted = sorted_by_key(candidates.key, never);
        odd_ += pick(sorted, candidates, limit, most);
        if (odd_ == 0) odd_ = pick(sorted, candidates, never, {1, no_limit});
    }

    /// The largest cost among the cheapest share of the candidates.
    std::uint32_t key_of_share(const Array<std::uint32_t>& keys) const {
        constexpr int shift = 20;
        std::array<std::size_t, 1 << (32 - shift)> count{};
        for (const std::uint32_t key : keys) ++count[key >> shift];
        const auto barred = static_cast<std::size_t>(std::count(keys.begin(), keys.end(), never));
        count.back() -= barred;
        if (keys.size() == barred) return never;
        const double wanted = std::ceil(share_ * static_cast<double>(keys.size() - barred));
        auto before = static_cast<std::size_t>(std::max(1.0, wanted)) - 1;  // of the one that is looked for
        std::size_t bucket = 0;
        while (before >= count[bucket]) before -= count[bucket++];
        Array<std::uint32_t> inside;
        for (const std::uint32_t key : keys)
            if (key >> shift == bucket && key != never) inside.push_back(key);
        const auto at = inside.begin() + static_cast<std::ptrdiff_t>(before);
        std::nth_element(inside.begin(), at, inside.end());
        return *at;
    }

    Index faces_of(Index v) const { return s_.rings.kind[v] == RingKind::closed ? 2 : 1; }

    /// Tries candidates in the order given, up to a cost and a number; gives the number taken.
    Index pick(const std::vector<Index>& sorted, const Candidates& candidates, std::uint32_t limit, Budget left) {
        Index odd = 0;
        std::vector<std::pair<double, Index>> others;
        for (const Index v : sorted) {
            if (left.spent() || candidates.key[v] > limit) break;
            if (state_[v] != free || !try_vertex(v, candidates.target[v], others)) continue;
            ++odd;
            --left.vertices;
            if (left.faces != no_limit) left.faces -= faces_of(v);
        }
        return odd;
    }

    bool try_vertex(Index v, Index best, std::vector<std::pair<double, Index>>& others) {
        const Ring ring = ring_of(s_.rings, v);
        if (allowed(v, ring, best)) return accept(v, ring, best);
        // The cheapest target is barred; try the others in order of cost, of a hub's the cheapest.
        others.clear();
        const Directions directions(ring);
        const Costs costs(s_, v, ring, options_);
        for (Index j = 0; j < ring.size; ++j) {
            if (j == best || !directions.allows(j)) continue;
            const double cost = costs[j];
            if (radix_key(static_cast<float>(cost)) <= most_of_others_) others.push_back({cost, j});
        }
        const auto end = others.begin() + std::min<std::size_t>(others.size(), collapse::hub);
        std::partial_sort(others.begin(), end, others.end());
        others.erase(end, others.end());
        for (const auto& [cost, j] : others)
            if (allowed(v, ring, j)) return accept(v, ring, j);
        return false;
    }

    bool allowed(Index v, const Ring& ring, Index j) const {
        return collapse::link_allows(
                   ring, j, [&](Index i) { return ring_of(s_.rings, i); }, [&](Index i) { return degree_[i]; },
                   [&](Index u, Index w) { return gained(u, w) || gained(w, u); }) &&
               collapse::faces_stay_good(v, ring.vertex[j], ring, s_.positions, limits_);
    }

    /// True if a vertex that went to u in this step had w in its ring.
    bool gained(Index u, Index w) const {
        if (!(state_[u] & target)) return false;
        const Ring of_u = ring_of(s_.rings, u), of_w = ring_of(s_.rings, w);
        const Ring& ring = collapse::is_hub_beside(of_u, of_w) ? of_w : of_u;
        for (Index j = 0; j < ring.size; ++j)
            if (parent_[ring.vertex[j]] == u && ring_of(s_.rings, ring.vertex[j]).find(w) >= 0) return true;
        return false;
    }

    bool accept(Index v, const Ring& ring, Index j) {
        const Index u = ring.vertex[j];
        parent_[v] = u;
        state_[v] = locked;
        Index gain = ring.size - 2;
        for (const Index w : {ring.before(j), ring.after(j)})
            if (w >= 0) --degree_[w], --gain;
        degree_[u] += gain;
        for (Index i = 0; i < ring.size; ++i) state_[ring.vertex[i]] |= locked;
        state_[u] |= target;
        return true;
    }

    const State& s_;
    const HierarchyOptions& options_;
    double share_;
    bool strict_;
    std::uint32_t most_of_others_ = never;
    collapse::FaceLimits limits_;
    Array<Index> degree_;
    Array<std::uint8_t> state_;
    Array<Index> parent_;
    Index odd_ = 0;
};

/// Mean length of the edges in the rings, those on the boundary counted as any other.
double mean_edge(const Rings& rings, const Positions& p) {
    const auto sum = chunked_fold<double>(rings.rows(), [&](double& lengths, std::size_t row) {
        const Index i = static_cast<Index>(row);
        for (Index j = 0; j < rings.size(i); ++j) lengths += (p[rings.begin(i)[j]] - p[i]).norm();
    });
    return rings.neighbor.empty() ? 0 : sum / static_cast<double>(rings.neighbor.size());
}

/// Numbers even and odd vertices in their order. Which is which is hard to predict: no branch.
void number(const Array<Index>& parent, Index odd, Step& step) {
    const Index n = static_cast<Index>(parent.size());
    step.code.resize(n);
    step.parent.resize(odd);
    const auto is_odd = [&](Index i) { return parent[i] >= 0; };
    ranked_for(n, is_odd, [&](Index i, Index odds) {
        Index nowhere;
        step.code[i] = is_odd(i) ? ~odds : i - odds;
        *(is_odd(i) ? &step.parent[odds] : &nowhere) = parent[i];
    });
}

/// Where the rings of even vertices begin after a step.
/// @param degree  #V: their sizes
Array<Index> offsets_after(const Step& step, const Array<Index>& degree) {
    const Index n = static_cast<Index>(degree.size());
    Array<Index> offset(n - static_cast<Index>(step.parent.size()) + 1);
    offset[0] = 0;
    parallel_for(n, [&](Index i) {
        Index nowhere;
        *(step.code[i] >= 0 ? &offset[step.code[i] + 1] : &nowhere) = degree[i];
    });
    add_up(offset);
    return offset;
}

/// Quadrics of even vertices, those of the vertices that went into them added.
void sum_quadrics(const State& s, const Step& step, State& t) {
    const Index n = s.rings.rows(), m = n - static_cast<Index>(step.parent.size());
    t.quadric.resize(m);
    t.error.resize(m);
    parallel_for(n, [&](Index i) {
        const Index to = step.code[i];
        if (to < 0) return;
        Quadric q = s.quadric[i];
        for (Index j = 0; j < s.rings.size(i); ++j) {
            const Index x = s.rings.begin(i)[j], code = step.code[x];
            if (code < 0 && step.parent[~code] == i) q.add_moved(s.quadric[x], s.positions[x] - s.positions[i]);
        }
        t.quadric[to] = q;
        t.error[to] = q.c;
    });
}

/// The state after a step: even vertices only, renumbered in their order.
/// @param s       its rings and positions stay; what else it has is gone as soon as it is not needed
/// @param move    see move_vertices()
/// @param degree  sizes of the rings after the step
State next_state(State& s, const Step& step, const Array<Index>& degree, const HierarchyOptions& options, bool move) {
    const Index n = s.rings.rows(), m = n - static_cast<Index>(step.parent.size());
    const bool has_features = !s.rings.feature.empty();
    State t;
    if (!options.memoryless) {
        sum_quadrics(s, step, t);
        s.quadric = Array<Quadric>();
        s.error = Array<double>();
    }
    t.rings.kind.resize(m);
    t.rings.offset = offsets_after(step, degree);
    t.positions.resize(m);
    t.rings.neighbor.resize(t.rings.offset[m]);
    if (has_features) t.rings.feature.resize(t.rings.offset[m]);
    const auto ring = [&](Index i) { return ring_of(s.rings, i); };
    const auto parent = [&](Index x) { return step.code[x] >= 0 ? -1 : step.parent[~step.code[x]]; };
    parallel_for(n, [&](Index i) {
        const Index to = step.code[i];
        if (to < 0) return;
        t.rings.kind[to] = s.rings.kind[i];
        t.positions[to] = s.positions[i];
        Index at = t.rings.offset[to];
        collapse::ring_after(i, ring(i), ring, parent, [&](Index x, bool mark) {
            if (has_features) t.rings.feature[at] = mark;
            t.rings.neighbor[at++] = step.code[x];
        });
    });
    if (move)
        move_vertices(s.rings, s.positions, step, std::cos(radians(options.normal_limit_degrees)), t.rings,
                      t.positions);
    return t;
}

/// The steps, and the state that they leave in s.
/// @param faces  how many there are to be taken
std::vector<Step> steps_of(State& s, const HierarchyOptions& options, Index faces, bool move, const Tick& tick) {
    std::vector<Step> steps;
    const double whole = static_cast<double>(s.rings.rows());
    const Index stop = options.base_vertices +
                       static_cast<Index>(std::count(s.rings.kind.begin(), s.rings.kind.end(), RingKind::isolated));
    for (;;) {
        const Index n = s.rings.rows();
        if (tick) tick(1 - n / whole);
        Selection selection(s, options, move);
        const Budget most{n - stop, faces};
        if (!most.spent()) selection.run(rank_vertices(s, options), most, steps.size() % 2 == 1);
        if (faces != no_limit) faces -= selection.faces_taken();
        Step step;
        number(selection.parent(), selection.odd(), step);
        State t;
        if (selection.odd() > 0) t = next_state(s, step, selection.degree(), options, move);
        if (options.mean_edges && (steps.size() % options.sets_per_level == 0 || selection.odd() == 0))
            step.mean_edge = mean_edge(s.rings, s.positions);
        if (!move) step.rings = std::move(s.rings);
        steps.push_back(std::move(step));
        if (selection.odd() == 0) return steps;
        s = std::move(t);
    }
}

State state_of(Rings rings, Positions positions, const HierarchyOptions& options) {
    State s;
    if (!options.memoryless) {
        s.quadric = vertex_quadrics(rings, positions, options.boundary_weight);
        s.error.assign(s.quadric.size(), 0);
    }
    s.rings = std::move(rings);
    s.positions = std::move(positions);
    return s;
}

}  // namespace

std::vector<Step> independent_sets(Rings rings, Positions positions, const HierarchyOptions& options,
                                   const Tick& tick) {
    State s = state_of(std::move(rings), std::move(positions), options);
    return steps_of(s, options, no_limit, false, tick);
}

std::vector<Step> moving_sets(Rings rings, Positions& positions, const HierarchyOptions& options, Index faces,
                              Index least, const Tick& tick) {
    State s = state_of(std::move(rings), std::move(positions), options);
    std::vector<Step> steps = steps_of(s, options, std::max<Index>(0, faces - least), true, tick);
    positions = std::move(s.positions);
    return steps;
}

}  // namespace multires
