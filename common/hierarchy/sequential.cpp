#include "hierarchy/sequential.h"

#include "base/angles.h"
#include "hierarchy/collapse.h"
#include "hierarchy/renumber.h"

#include <numeric>
#include <queue>

namespace multires {
namespace {

using collapse::Directions;
using collapse::Ring;

/// A ring that can change.
struct Row {
    std::vector<Index> vertex;
    std::vector<std::uint8_t> feature;  // as long as `vertex`, or empty if the mesh has no features
    RingKind kind = RingKind::isolated;
};

class Sequence {
public:
    Sequence(const Rings& rings, const Positions& positions, const HierarchyOptions& options)
        : positions_(positions), options_(options), limits_{std::cos(radians(options.normal_limit_degrees))},
          rows_(rings.rows()), quadric_(rings.rows()), stamp_(rings.rows(), 0), parent_(rings.rows(), -1),
          alive_(rings.rows(), 1), left_(rings.rows()),
          stop_(options.base_vertices +
                static_cast<Index>(std::count(rings.kind.begin(), rings.kind.end(), RingKind::isolated))),
          features_(!rings.feature.empty()) {
        for (Index i = 0; i < rings.rows(); ++i) {
            const Ring r = collapse::ring_of(rings, i);
            rows_[i].vertex.assign(r.vertex, r.vertex + r.size);
            if (features_) rows_[i].feature.assign(r.feature, r.feature + r.size);
            rows_[i].kind = r.kind;
            quadric_[i] = collapse::vertex_quadric(i, ring(i), positions);
        }
        for (Index i = 0; i < rings.rows(); ++i) push(i);
    }

    Hierarchy run(const Tick& tick) {
        h_.size.push_back(left_);
        const double whole = left_;
        start_level();
        while (left_ > stop_ && !queue_.empty()) {
            const Entry e = queue_.top();
            queue_.pop();
            if (!alive_[e.vertex] || e.stamp != stamp_[e.vertex]) continue;
            const Index target = best_allowed(e.vertex);
            if (target < 0) continue;  // queued again when something changes around it
            remove(e.vertex, target);
            if (left_ == cut_) end_level(), start_level();
            if (tick && left_ % 1024 == 0) tick(1 - left_ / whole);
        }
        if (left_ < h_.size.back()) end_level();
        queue_ = {};  // the tables of the result take their place
        quadric_ = {};
        number();
        return std::move(h_);
    }

private:
    struct Entry {
        double cost;
        Index vertex, stamp;
        bool operator<(const Entry& o) const { return cost != o.cost ? cost > o.cost : vertex > o.vertex; }
    };

    Ring ring(Index i) const {
        const Row& r = rows_[i];
        return {r.vertex.data(), features_ ? r.feature.data() : nullptr, static_cast<Index>(r.vertex.size()), r.kind};
    }

    double cost(Index v, Index u) const {
        if (options_.split == Split::regression_plane) return collapse::sum_of_turns(v, u, ring(v), positions_);
        return collapse::cost(quadric_[v], quadric_[u].c, positions_[u] - positions_[v], options_.length_weight);
    }

    void push(Index v) {
        const Ring r = ring(v);
        const Directions directions(r);
        if (directions.none()) return;
        double least = -1;
        if (options_.split == Split::regression_plane)
            least = collapse::distance_from_ring(v, r, directions, positions_);
        for (Index j = 0; j < r.size && options_.split == Split::quadric; ++j)
            if (directions.allows(j)) {
                const double c = cost(v, r.vertex[j]);
                if (least < 0 || c < least) least = c;
            }
        if (least >= 0) queue_.push({least * collapse::jitter(v, options_.seed), v, ++stamp_[v]});
    }

    /// Entry of the cheapest target that is allowed, -1 if none is.
    Index best_allowed(Index v) {
        const Ring r = ring(v);
        const Directions directions(r);
        targets_.clear();
        for (Index j = 0; j < r.size; ++j)
            if (directions.allows(j)) targets_.push_back({cost(v, r.vertex[j]), j});
        std::sort(targets_.begin(), targets_.end());
        const auto ring_of = [&](Index i) { return ring(i); };
        const auto degree = [&](Index i) { return static_cast<Index>(rows_[i].vertex.size()); };
        const auto adjacent = [](Index, Index) { return false; };  // rings are always up to date
        for (const auto& [c, j] : targets_)
            if (collapse::link_allows(r, j, ring_of, degree, adjacent) &&
                collapse::faces_stay_good(v, r.vertex[j], r, positions_, limits_))
                return j;
        return -1;
    }

    void remove(Index v, Index entry) {
        const Ring r = ring(v);
        const Index u = r.vertex[entry];
        record(odd_, v);
        removed_.push_back(v);
        if (single())
            for (Index j = 0; j < r.size && options_.even_rings; ++j)
                record(even_, r.vertex[j]), even_vertex_.push_back(r.vertex[j]);
        parent_[v] = u;
        const auto ring_of = [&](Index i) { return ring(i); };
        const auto odd_parent = [&](Index x) { return x == v ? u : -1; };
        std::vector<Row> changed(r.size);
        for (Index j = 0; j < r.size; ++j) {
            const Index i = r.vertex[j];
            changed[j].kind = rows_[i].kind;
            collapse::ring_after(i, ring(i), ring_of, odd_parent, [&](Index x, bool mark) {
                changed[j].vertex.push_back(x);
                if (features_) changed[j].feature.push_back(mark);
            });
        }
        for (Index j = 0; j < r.size; ++j) rows_[r.vertex[j]] = std::move(changed[j]);
        quadric_[u].add_moved(quadric_[v], positions_[v] - positions_[u]);
        alive_[v] = 0;
        rows_[v] = Row();
        --left_;
        push(u);
        for (const Index w : rows_[u].vertex) push(w);
    }

    /// Appends the present ring of a vertex, with flaps, to a table.
    void record(Rings& table, Index v) const {
        const Ring r = ring(v);
        for (Index j = 0; j < r.size; ++j) {
            table.neighbor.push_back(r.vertex[j]);
            if (options_.flaps)
                table.flap.push_back(r.closed() ? flap(v, r.vertex[j], r.after(j)) : beyond_end(v, r, j));
            if (features_) table.feature.push_back(r.feature[j]);
        }
        table.offset.push_back(static_cast<Index>(table.neighbor.size()));
        table.kind.push_back(r.kind);
    }

    /// Flaps of open rings.
    Index beyond_end(Index v, const Ring& r, Index j) const {
        const bool end = j == 0 || j + 1 == r.size;
        return end ? next_on_boundary(v, r.vertex[j]) : r.vertex[j];
    }

    Index flap(Index v, const Index a, const Index b) const {
        const Index beyond = beyond_edge(v, a, b);
        return beyond >= 0 ? beyond : a;
    }

    /// See mesh/adjacency.h.
    Index next_on_boundary(Index from, Index at) const {
        const Ring r = ring(at);
        if (!r.regular() || r.closed() || Directions(r).none()) return at;
        const Index first = r.vertex[0], last = r.vertex[r.size - 1];
        return first == from ? last : last == from ? first : at;
    }

    Index beyond_edge(Index v, Index a, Index b) const {
        if (rows_[a].vertex.empty()) std::swap(a, b);
        const Ring r = ring(a);
        const Index j = r.find(b);
        if (j < 0 || r.marked(j)) return -1;
        return r.before(j) == v ? r.after(j) : r.before(j);
    }

    bool single() const { return options_.level_ratio <= 0; }

    void start_level() {
        cut_ = single() ? left_ - 1 : std::max(stop_, static_cast<Index>(left_ * options_.level_ratio));
        cut_ = std::min(cut_, left_ - 1);
        even_ = Rings();
        even_vertex_.clear();
        if (single() || !options_.even_rings) return;
        for (Index i = 0; i < static_cast<Index>(rows_.size()); ++i)
            if (alive_[i]) record(even_, i), even_vertex_.push_back(i);
    }

    /// Level::cuts of rows in order of insertion: sets are as long as no row refers to another of its own.
    static std::vector<Index> cuts_of(const Rings& odd, RowRange rows) {
        std::vector<Index> cuts;
        Index first = odd.first + rows.begin;  // place of the set
        for (Index r = rows.begin; r < rows.end; ++r) {
            bool refers = false;
            for (Index k = odd.offset[r]; k < odd.offset[r + 1]; ++k)
                refers |= odd.neighbor[k] >= first || (!odd.flap.empty() && odd.flap[k] >= first);
            if (refers) cuts.push_back(r), first = odd.first + r;
        }
        return cuts;
    }

    /// Stores the even rings in local numbers; number() turns them into places.
    void end_level() {
        h_.size.push_back(left_);
        if (!options_.even_rings) return;
        h_.even.push_back(std::move(even_));
        h_.even.back().vertices = even_vertex_;
    }

    void number() {
        const Index n = static_cast<Index>(rows_.size());
        h_.order.resize(n);
        Array<Index> place(n);
        Index at = 0;
        for (Index i = 0; i < n; ++i)
            if (alive_[i]) h_.order[at++] = i;
        for (std::size_t r = 0; r < removed_.size(); ++r) h_.order[n - 1 - r] = removed_[r];
        for (Index p = 0; p < n; ++p) place[h_.order[p]] = p;
        h_.parent.assign(n, -1);
        for (const Index v : removed_) h_.parent[place[v]] = place[parent_[v]];

        Rings base;
        for (Index p = 0; p < left_; ++p) record(base, h_.order[p]);
        Array<Index> all(left_);
        std::iota(all.begin(), all.end(), 0);
        h_.base = renumbered(base, all, place, n, options_.flaps);
        rows_ = {};

        Array<Index> rows(removed_.size());  // recorded in order of removal, wanted in order of insertion
        for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = static_cast<Index>(rows.size() - 1 - r);
        h_.odd = renumbered(odd_, rows, place, n, options_.flaps);
        h_.odd.first = left_;
        h_.size.shrink_to_fit();
        h_.levels.resize(h_.size.size() - 1);
        for (std::size_t k = 0; k < h_.levels.size(); ++k) {
            Level& level = h_.levels[k];
            level.fine = h_.size[k], level.coarse = h_.size[k + 1];
            level.odd = {level.coarse - left_, level.fine - left_};
            level.cuts = cuts_of(h_.odd, level.odd);
        }
        for (std::size_t k = 0; k < h_.even.size(); ++k) number_even(h_.even[k], place, h_.levels[k]);
    }

    static void number_even(Rings& even, const Array<Index>& place, const Level& level) {
        Array<Index> rows;
        for (Index r = 0; r < even.rows(); ++r)
            if (place[even.vertices[r]] < level.coarse) rows.push_back(r);
        const Array<Index> vertex = std::move(even.vertices);
        even = renumbered(even, rows, place, level.fine, !even.flap.empty());
        for (const Index r : rows) even.vertices.push_back(place[vertex[r]]);
    }

    const Positions& positions_;
    const HierarchyOptions& options_;
    collapse::FaceLimits limits_;
    std::vector<Row> rows_;
    std::vector<Quadric> quadric_;
    std::vector<Index> stamp_, parent_;
    std::vector<std::uint8_t> alive_;
    Index left_, stop_, cut_ = 0;
    bool features_;
    std::priority_queue<Entry> queue_;
    std::vector<std::pair<double, Index>> targets_;
    std::vector<Index> removed_;
    Array<Index> even_vertex_;
    Rings odd_, even_;
    Hierarchy h_;
};

}  // namespace

Hierarchy sequential(const Rings& rings, const Positions& positions, const HierarchyOptions& options,
                     const Tick& tick) {
    return Sequence(rings, positions, options).run(tick);
}

}  // namespace multires
