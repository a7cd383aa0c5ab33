#include "denoise/value_impulses.h"

#include "base/median.h"
#include "base/parallel.h"
#include "base/reduce.h"
#include "denoise/value_slopes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace multires {
namespace {

constexpr Index least_neighbours = 3;
constexpr double outlying = 5;           ///< times what is usual around: an impulse
constexpr int passes = 3;                ///< impulses next to each other are found one after the other
constexpr double highest = 4;            ///< times the median of all impulses: more is of another kind
constexpr double least_share = 0.004;    ///< of the vertices: fewer are spots
constexpr double most_rank = 0.65;       ///< mean share of all vertices that bend less: more is shape
constexpr double most_clustering = 1.1;  ///< 1 for hits anywhere, 0 where they keep apart
constexpr double clearly = 3;            ///< standard deviations
constexpr int widest = 4;

/// Values as they are seen from each vertex: less what they rise there.
class Ranks {
public:
    Ranks(const ValueSurface& surface, std::vector<double> values, int width)
        : near_(surface.near), positions_(surface.positions), values_(std::move(values)), width_(width),
          slope_(value_slopes(surface.near, surface.positions, surface.normal, values_, width)) {}

    const Neighbours& near() const { return near_; }
    /// Of the neighbours that are no impulses, channel by channel; false if there are too few.
    bool median(Index v, const std::vector<std::uint8_t>& impulse, double* to) const {
        std::vector<double> around;
        for (int c = 0; c < width_; ++c) {
            around.clear();
            for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k)
                if (!impulse[near_.vertex[k]]) around.push_back(seen(v, near_.vertex[k], c));
            if (around.empty()) return false;
            const auto [lower, upper] = middle_values(around);
            to[c] = (lower + upper) / 2;
        }
        return true;
    }
    /// Distance of the value from its neighbours' of this rank.
    double distance_of_rank(Index v, Index rank) const { return quantile_of_distances(v, seen(v, v), rank); }
    /// The share of the vertices two edges away whose values are nearer to it than to its neighbours' median.
    double alike_beyond(Index v) const {
        Value middle{};
        if (!median_of_all(v, middle)) return 1;
        std::vector<Index> ring;
        two_rings(near_, v, ring);
        double alike = 0, all = 0;
        const auto row = near_.vertex.begin();
        for (const Index w : ring) {
            if (std::binary_search(row + near_.offset[v], row + near_.offset[v + 1], w)) continue;
            ++all;
            alike += nearer(v, w, middle);
        }
        return all > 0 ? alike / all : 1;
    }
    /// How far a value is from its neighbours' median.
    double height(Index v) const {
        Value middle{};
        return median_of_all(v, middle) ? distance(seen(v, v), middle) : 0;
    }
    /// Whether more than `most` connected vertices, with this one, have values nearer to its own than to its
    /// neighbours' median.
    bool goes_on(Index v, std::size_t most) const {
        Value middle{};
        median_of_all(v, middle);
        std::vector<Index> alike{v};
        for (std::size_t next = 0; next < alike.size() && alike.size() <= most; ++next)
            for (Index k = near_.offset[alike[next]]; k < near_.offset[alike[next] + 1] && alike.size() <= most; ++k) {
                const Index w = near_.vertex[k];
                if (nearer(v, w, middle) && std::find(alike.begin(), alike.end(), w) == alike.end()) alike.push_back(w);
            }
        return alike.size() > most;
    }
    /// How far most neighbours are from their median; some may be impulses, too.
    /// @param others  how many
    double spread(Index v, Index others) const {
        Value middle{};
        return median_of_all(v, middle)
                   ? quantile_of_distances(v, middle, std::min(2 * near_.size(v) / 3, near_.size(v) - 1 - others))
                   : 0;
    }

private:
    using Value = std::array<double, widest>;
    double distance(const Value& a, const Value& b) const {
        double square = 0;
        for (int c = 0; c < width_; ++c) square += (a[c] - b[c]) * (a[c] - b[c]);
        return std::sqrt(square);
    }
    /// The value of w, from v.
    Value seen(Index v, Index w) const {
        Value value{};
        for (int c = 0; c < width_; ++c) value[c] = seen(v, w, c);
        return value;
    }
    double seen(Index v, Index w, int c) const {
        return values_[static_cast<std::size_t>(w) * width_ + c] -
               slope_[static_cast<std::size_t>(v) * width_ + c].dot(positions_[w] - positions_[v]);
    }
    /// Whether the value of w is nearer to that of v than to what is usual there.
    bool nearer(Index v, Index w, const Value& usual) const {
        const Value other = seen(v, w);
        return distance(other, seen(v, v)) < distance(other, usual);
    }
    bool median_of_all(Index v, Value& to) const {
        std::vector<double> around;
        for (int c = 0; c < width_; ++c) {
            around.clear();
            for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k) around.push_back(seen(v, near_.vertex[k], c));
            if (around.empty()) return false;
            to[c] = lower_quantile(around, 0.5);
        }
        return true;
    }
    double quantile_of_distances(Index v, const Value& from, Index rank) const {
        std::vector<double> all;
        for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k)
            all.push_back(distance(seen(v, near_.vertex[k]), from));
        rank = std::min(rank, static_cast<Index>(all.size()) - 1);
        std::nth_element(all.begin(), all.begin() + rank, all.end());
        return all[rank];
    }

    const Neighbours& near_;
    const Positions& positions_;
    std::vector<double> values_;
    int width_;
    std::vector<Vec3> slope_;  ///< #V by width
};

/// What passes for an impulse.
struct Limits {
    double alike = 0.1;      ///< share of the vertices two edges away with such a value: more is a pattern
    std::size_t patch = 2;   ///< connected vertices with such a value: more is a pattern
    Index alike_around = 1;  ///< neighbours with such a value
};

/// If about this share of the vertices are impulses, several are next to each other by chance.
Limits limits_for(double share) {
    Limits limits;
    limits.alike = std::max(limits.alike, share + 3 * std::sqrt(share / 12));
    if (share > 0.03) limits.patch = 4, limits.alike_around = 2;
    return limits;
}

std::vector<std::uint8_t> found_impulses(const Ranks& ranks, const Limits& limits) {
    const Neighbours& near = ranks.near();
    const auto alike = [&](Index v) { return std::min(limits.alike_around, near.size(v) / 3); };
    std::vector<double> lonely(near.rows(), 0);
    std::vector<std::uint8_t> impulse(near.rows(), 0);
    parallel_for(near.rows(), [&](Index v) {
        if (near.size(v) >= least_neighbours) lonely[v] = ranks.distance_of_rank(v, alike(v));
    });
    parallel_for(near.rows(), [&](Index v) {
        if (near.size(v) < least_neighbours || !(lonely[v] > 0)) return;
        std::vector<double> around;
        for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) around.push_back(lonely[near.vertex[k]]);
        const double usual = std::max(lower_quantile(around, 0.5), ranks.spread(v, alike(v)));
        impulse[v] =
            lonely[v] > outlying * usual && ranks.alike_beyond(v) < limits.alike && !ranks.goes_on(v, limits.patch);
    });
    return impulse;
}

std::size_t count_of(const std::vector<std::uint8_t>& impulse) {
    return static_cast<std::size_t>(std::count(impulse.begin(), impulse.end(), 1));
}

/// Unmarks those higher than `most`.
void keep_high(const Ranks& ranks, double most, std::vector<std::uint8_t>& impulse) {
    parallel_for(ranks.near().rows(), [&](Index v) {
        if (impulse[v]) impulse[v] = ranks.height(v) <= most;
    });
}

double median_height(const Ranks& ranks, const std::vector<std::uint8_t>& impulse) {
    std::vector<double> heights;
    for (Index v = 0; v < ranks.near().rows(); ++v)
        if (impulse[v]) heights.push_back(ranks.height(v));
    return heights.empty() ? 0 : lower_quantile(heights, 0.5);
}

/// Hits among samples of noise.
std::size_t by_chance(const ValueSurface& surface, int width) {
    std::vector<double> noise(static_cast<std::size_t>(surface.near.rows()) * width);
    for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = gaussian(static_cast<Index>(i), 400);
    return count_of(found_impulses(Ranks(surface, noise, width), {}));
}

/// Whether there are more hits among the vertices around hits than if they were anywhere, by more than chance.
bool cluster(const Neighbours& near, const std::vector<std::uint8_t>& impulse) {
    std::vector<double> around(impulse.begin(), impulse.end());
    average(near, around, 1, 2);
    Mean at_hits, all;
    for (std::size_t i = 0; i < impulse.size(); ++i) {
        all.add(around[i]);
        if (impulse[i]) at_hits.add(around[i]);
    }
    // A hit by itself: what is left of it there after two averages, about 0.2.
    std::vector<double> alone(impulse.size());
    parallel_for(near.rows(), [&](Index v) {
        double back = 1.0 / (1 + near.size(v));
        alone[v] = back * back;
        for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) alone[v] += back / (1 + near.size(near.vertex[k]));
    });
    Mean self, ring;
    std::vector<Index> reached;
    for (std::size_t i = 0; i < impulse.size(); ++i)
        if (impulse[i]) {
            self.add(alone[i]);
            two_rings(near, static_cast<Index>(i), reached);
            ring.add(static_cast<double>(reached.size()));
        }
    if (!(all.value() > 0)) return false;
    const double pairs = ring.weight * ring.value() * all.value() / 2;  // expected of hits anywhere
    return (at_hits.value() - self.value()) / all.value() > most_clustering + clearly / std::sqrt(pairs);
}

/// Mean share of all vertices that have less of something than the hits: about a half if it is nothing to them.
double mean_rank(const std::vector<std::uint8_t>& impulse, const std::vector<double>& something) {
    std::vector<double> sorted = something;
    std::sort(sorted.begin(), sorted.end());
    Mean rank;
    for (std::size_t i = 0; i < impulse.size(); ++i) {
        if (!impulse[i]) continue;
        const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), something[i]);
        rank.add(static_cast<double>(first - sorted.begin() + (last - sorted.begin())) / 2);
    }
    return rank.value() / static_cast<double>(sorted.size());
}

/// Whether they are elsewhere than what belongs to the surface would be.
bool independent_of_shape(const ValueSurface& surface, const std::vector<std::uint8_t>& impulse) {
    if (mean_rank(impulse, surface.bend) > most_rank) return false;
    const Neighbours& near = surface.near;
    const double usual = std::round(static_cast<double>(near.vertex.size()) / near.rows());
    std::vector<double> irregular(near.rows());
    for (Index v = 0; v < near.rows(); ++v) irregular[v] = std::abs(near.size(v) - usual);
    return mean_rank(impulse, irregular) <= most_rank;
}

/// Replaces those marked; those without a neighbour that is none are no longer marked.
void replace(const Ranks& ranks, std::vector<std::uint8_t>& impulse, std::vector<double>& values, int width) {
    const std::vector<std::uint8_t> marked = impulse;
    parallel_for(ranks.near().rows(), [&](Index v) {
        if (marked[v]) impulse[v] = ranks.median(v, marked, values.data() + static_cast<std::size_t>(v) * width);
    });
}

}  // namespace

ValueImpulses without_impulses(const ValueSurface& surface, const std::vector<double>& values, int width) {
    const std::size_t count = surface.positions.size();
    ValueImpulses out{values, std::vector<std::uint8_t>(count, 0), 0};
    std::optional<Ranks> ranks(std::in_place, surface, values, width);
    std::vector<std::uint8_t> hits = found_impulses(*ranks, {});
    const auto all = static_cast<double>(count), found = static_cast<double>(count_of(hits));
    if (found < std::max(5.0, least_share * all) || !independent_of_shape(surface, hits)) return out;
    const auto chance = static_cast<double>(by_chance(surface, width));
    if (found <= 2 * chance || cluster(surface.near, hits)) return out;
    const Limits limits = limits_for(found / all);
    const double most_height = highest * median_height(*ranks, hits);
    for (int pass = 0; pass < passes; ++pass) {
        if (pass > 0) ranks.emplace(surface, out.values, width);
        hits = found_impulses(*ranks, limits);
        keep_high(*ranks, most_height, hits);
        replace(*ranks, hits, out.values, width);
        for (std::size_t i = 0; i < count; ++i) out.impulse[i] |= hits[i];
    }
    out.count = count_of(out.impulse);
    return out;
}

}  // namespace multires
