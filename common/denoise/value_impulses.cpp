#include "denoise/value_impulses.h"

#include "base/median.h"
#include "base/parallel.h"
#include "base/reduce.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace multires {
namespace {

constexpr Index least_neighbours = 3, most_around = 64;
constexpr double outlying = 5;           ///< times what is usual around: an impulse
constexpr int passes = 3;                ///< impulses next to each other are found one after the other
constexpr double highest = 4;            ///< times the median of all impulses: more is of another kind
constexpr double least_share = 0.004;    ///< of the vertices: fewer are spots
constexpr double most_bend = 1.5;        ///< times that of all vertices: more is shape
constexpr double most_clustering = 1.1;  ///< 1 for hits anywhere, 0 where they keep apart
constexpr int widest = 4;

/// Values with their neighbours.
class Ranks {
public:
    Ranks(const Neighbours& near, const std::vector<double>& values, int width)
        : near_(near), values_(values), width_(width) {}

    /// Of the neighbours that are no impulses, channel by channel; false if there are too few.
    bool median(Index v, const std::vector<std::uint8_t>& impulse, double* to) const {
        std::vector<double> around;
        for (int c = 0; c < width_; ++c) {
            around.clear();
            for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k)
                if (!impulse[near_.vertex[k]]) around.push_back(at(near_.vertex[k])[c]);
            if (around.empty()) return false;
            const double upper = upper_median(around);
            const auto half = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
            to[c] = around.size() % 2 == 1 ? upper : (upper + *std::max_element(around.begin(), half)) / 2;
        }
        return true;
    }
    /// Distance of the value from its neighbours' of this rank.
    double distance_of_rank(Index v, Index rank) const { return quantile_of_distances(v, at(v), rank); }
    /// The share of the vertices two edges away whose values are nearer to it than to its neighbours' median.
    double alike_beyond(Index v) const {
        std::array<double, widest> middle{};
        if (!median_of_all(v, middle.data())) return 1;
        std::vector<Index> ring;
        for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k) {
            const Index w = near_.vertex[k];
            if (near_.size(w) > most_around) continue;  // a hub, around which all would be beyond
            ring.insert(ring.end(), near_.vertex.begin() + near_.offset[w], near_.vertex.begin() + near_.offset[w + 1]);
        }
        std::sort(ring.begin(), ring.end());
        ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
        double alike = 0, all = 0;
        const auto row = near_.vertex.begin();
        for (const Index w : ring) {
            if (w == v || std::binary_search(row + near_.offset[v], row + near_.offset[v + 1], w)) continue;
            ++all;
            alike += distance(at(w), at(v)) < distance(at(w), middle.data());
        }
        return all > 0 ? alike / all : 1;
    }
    /// How far a value is from its neighbours' median.
    double height(Index v) const {
        std::array<double, widest> middle{};
        return median_of_all(v, middle.data()) ? distance(at(v), middle.data()) : 0;
    }
    /// Whether more than `most` connected vertices, with this one, have values nearer to its own than to its
    /// neighbours' median.
    bool goes_on(Index v, std::size_t most) const {
        std::array<double, widest> middle{};
        median_of_all(v, middle.data());
        std::vector<Index> alike{v};
        for (std::size_t next = 0; next < alike.size() && alike.size() <= most; ++next)
            for (Index k = near_.offset[alike[next]]; k < near_.offset[alike[next] + 1] && alike.size() <= most; ++k) {
                const Index w = near_.vertex[k];
                if (distance(at(w), at(v)) < distance(at(w), middle.data()) &&
                    std::find(alike.begin(), alike.end(), w) == alike.end())
                    alike.push_back(w);
            }
        return alike.size() > most;
    }
    /// How far most neighbours are from their median.
    double spread(Index v) const {
        std::array<double, widest> middle{};
        if (!median_of_all(v, middle.data())) return 0;
        return quantile_of_distances(v, middle.data(), 2 * near_.size(v) / 3);
    }

private:
    double distance(const double* a, const double* b) const {
        double square = 0;
        for (int c = 0; c < width_; ++c) square += (a[c] - b[c]) * (a[c] - b[c]);
        return std::sqrt(square);
    }
    const double* at(Index v) const { return values_.data() + static_cast<std::size_t>(v) * width_; }
    bool median_of_all(Index v, double* to) const {
        std::vector<double> around;
        for (int c = 0; c < width_; ++c) {
            around.clear();
            for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k) around.push_back(at(near_.vertex[k])[c]);
            if (around.empty()) return false;
            to[c] = lower_quantile(around, 0.5);
        }
        return true;
    }
    double quantile_of_distances(Index v, const double* from, Index rank) const {
        std::vector<double> all;
        for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k)
            all.push_back(distance(at(near_.vertex[k]), from));
        rank = std::min(rank, static_cast<Index>(all.size()) - 1);
        std::nth_element(all.begin(), all.begin() + rank, all.end());
        return all[rank];
    }

    const Neighbours& near_;
    const std::vector<double>& values_;
    int width_;
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

std::vector<std::uint8_t> found_impulses(const Neighbours& near, const std::vector<double>& values, int width,
                                         const Limits& limits) {
    const Ranks ranks(near, values, width);
    std::vector<double> lonely(near.rows(), 0);
    std::vector<std::uint8_t> impulse(near.rows(), 0);
    parallel_for(near.rows(), [&](Index v) {
        if (near.size(v) >= least_neighbours)
            lonely[v] = ranks.distance_of_rank(v, std::min(limits.alike_around, near.size(v) / 3));
    });
    parallel_for(near.rows(), [&](Index v) {
        if (near.size(v) < least_neighbours || !(lonely[v] > 0)) return;
        std::vector<double> around;
        for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) around.push_back(lonely[near.vertex[k]]);
        const double usual = std::max(lower_quantile(around, 0.5), ranks.spread(v));
        impulse[v] =
            lonely[v] > outlying * usual && ranks.alike_beyond(v) < limits.alike && !ranks.goes_on(v, limits.patch);
    });
    return impulse;
}

std::size_t count_of(const std::vector<std::uint8_t>& impulse) {
    return static_cast<std::size_t>(std::count(impulse.begin(), impulse.end(), 1));
}

/// Unmarks those higher than `most`.
void keep_high(const Neighbours& near, const std::vector<double>& values, int width, double most,
               std::vector<std::uint8_t>& impulse) {
    const Ranks ranks(near, values, width);
    parallel_for(near.rows(), [&](Index v) {
        if (impulse[v]) impulse[v] = ranks.height(v) <= most;
    });
}

double median_height(const Neighbours& near, const std::vector<double>& values, int width,
                     const std::vector<std::uint8_t>& impulse) {
    const Ranks ranks(near, values, width);
    std::vector<double> heights;
    for (Index v = 0; v < near.rows(); ++v)
        if (impulse[v]) heights.push_back(ranks.height(v));
    return heights.empty() ? 0 : lower_quantile(heights, 0.5);
}

/// Hits among samples of noise.
std::size_t by_chance(const Neighbours& near, int width) {
    std::vector<double> noise(static_cast<std::size_t>(near.rows()) * width);
    for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = gaussian(static_cast<Index>(i), 400);
    return count_of(found_impulses(near, noise, width, {}));
}

/// Hits among the vertices around hits, over those there would be if they were anywhere.
double clustering(const Neighbours& near, const std::vector<std::uint8_t>& impulse) {
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
    Mean self;
    for (std::size_t i = 0; i < impulse.size(); ++i)
        if (impulse[i]) self.add(alone[i]);
    return all.value() > 0 ? (at_hits.value() - self.value()) / all.value() : 0;
}

/// Whether they are more, and elsewhere, than what belongs to the surface would be.
bool independent_of_shape(const std::vector<std::uint8_t>& impulse, const std::vector<double>& bend) {
    Mean hit, all;
    for (std::size_t i = 0; i < impulse.size(); ++i) {
        all.add(bend[i]);
        if (impulse[i]) hit.add(bend[i]);
    }
    return hit.weight >= std::max(5.0, least_share * all.weight) && hit.value() <= most_bend * all.value();
}

/// Replaces those marked; those without a neighbour that is none are no longer marked.
void replace(const Neighbours& near, std::vector<std::uint8_t>& impulse, std::vector<double>& values, int width) {
    const std::vector<double> before = values;
    const std::vector<std::uint8_t> marked = impulse;
    const Ranks ranks(near, before, width);
    parallel_for(near.rows(), [&](Index v) {
        if (marked[v]) impulse[v] = ranks.median(v, marked, values.data() + static_cast<std::size_t>(v) * width);
    });
}

}  // namespace

ValueImpulses without_impulses(const Neighbours& near, const std::vector<double>& bend,
                               const std::vector<double>& values, int width) {
    ValueImpulses out{values, std::vector<std::uint8_t>(bend.size(), 0), 0};
    std::vector<std::uint8_t> hits = found_impulses(near, values, width, {});
    if (!independent_of_shape(hits, bend) || count_of(hits) <= 2 * by_chance(near, width)) return out;
    if (clustering(near, hits) > most_clustering) return out;
    const Limits limits = limits_for(static_cast<double>(count_of(hits)) / static_cast<double>(hits.size()));
    const double most_height = highest * median_height(near, values, width, hits);
    for (int pass = 0; pass < passes; ++pass) {
        hits = found_impulses(near, out.values, width, limits);
        keep_high(near, out.values, width, most_height, hits);
        replace(near, hits, out.values, width);
        for (std::size_t i = 0; i < hits.size(); ++i) out.impulse[i] |= hits[i];
    }
    out.count = count_of(out.impulse);
    return out;
}

}  // namespace multires
