#include "denoise/weak_impulses.h"

#include "base/median.h"
#include "base/parallel.h"
#include "denoise/crease_fit.h"
#include "denoise/least_deviations.h"
#include "measure/vertex_normals.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr std::size_t least_points = 9, most_points = 64;  ///< half as many again as a quadric has to be chosen
constexpr int rounds = 6;
constexpr double smallest = 1e-3;  ///< deviation that counts, of the largest
/// Share of the deviations that are usual, from a quadric and from a plane; the least, of the mean distance around.
constexpr double most = 0.75, most_beside_crease = 0.5, least_usual = 1e-3;
constexpr Index looked_at = 3000;
constexpr double certain = 8, likely = 4;  ///< times what is usual: impulses; once it is known that there are some
constexpr double impulsive = 0.015;        ///< share of the former in the quietest third
constexpr std::size_t least_count = 10;    ///< of them: fewer may be single features
constexpr double lopsided = 3;             ///< standard deviations of how many are to one side
/// Times the median of them, and the highest: more is of another kind.
constexpr double highest_of_median = 4, highest_of_most = 1.5;
constexpr int alike = 2;   ///< neighbours as far off to the same side: shape
constexpr int passes = 2;  ///< an impulse may hide behind others

using Quadric = Eigen::Matrix<double, 6, 1>;
using Plane = Eigen::Matrix<double, 3, 1>;

/// A vertex above what those around predict.
struct Height {
    double value = 0, usual = 0;  ///< usual is 0 where nothing is known, or it is not alone
    Vec3 normal = Vec3::Zero();
    bool above(double times) const { return usual > 0 && std::abs(value) > times * usual; }
};

/// The value of the quadric, or the plane, at the origin.
/// @param[out] deviation  #values: from it
template <class Terms>
double value_at_origin(const std::vector<Terms>& terms, const std::vector<double>& values,
                       std::vector<double>& deviation) {
    deviation.assign(values.size(), 1);
    Terms fit = Terms::Zero();
    for (int round = 0; round < rounds; ++round) {
        double largest = 0;
        for (const double d : deviation) largest = std::max(largest, std::abs(d));
        fit = towards_least_deviations(terms, values, deviation, std::max(1e-12, smallest * largest));
    }
    return fit[0];
}

class Heights {
public:
    Heights(const Faces& faces, const Positions& p, const Incidence& at, const Neighbours& near)
        : faces_(faces), p_(p), at_(at), near_(near) {}

    Height over_quadric(Index v) const { return over<Quadric>(v, most); }
    /// Where a crease goes through the vertices around, which no quadric follows.
    Height over_plane(Index v) const { return over<Plane>(v, most_beside_crease); }

private:
    template <class Terms>
    Height over(Index v, double share) const {
        Height height;
        std::vector<Index> ring;
        if (!near_.rim[v]) two_rings(near_, v, ring);
        if (ring.size() < least_points || ring.size() > most_points) return height;
        height.normal = normal_around(v);
        double unit = 0;
        for (const Index w : ring) unit += (p_[w] - p_[v]).norm() / static_cast<double>(ring.size());
        if (!(height.normal.squaredNorm() > 0 && unit > 0)) return height;
        const Vec3 first = height.normal.unitOrthogonal(), second = height.normal.cross(first);
        std::vector<Terms> terms;
        std::vector<double> values, deviation;
        for (const Index w : ring) {
            const Vec3 d = (p_[w] - p_[v]) / unit;
            const double x = d.dot(first), y = d.dot(second);
            const Quadric all = (Quadric() << 1, x, y, x * x, x * y, y * y).finished();
            terms.push_back(all.head<Terms::RowsAtCompileTime>());
            values.push_back(d.dot(height.normal));
        }
        height.value = -unit * value_at_origin(terms, values, deviation);
        if (goes_on(v, height.value / unit, ring, deviation)) return height;
        for (double& d : deviation) d = std::abs(d);
        height.usual = unit * std::max(least_usual, lower_quantile(deviation, share));
        return height;
    }

    /// Whether neighbours are up there, too, as on cliffs.
    bool goes_on(Index v, double value, const std::vector<Index>& ring, const std::vector<double>& deviation) const {
        const auto row = near_.vertex.begin();
        int beside = 0;
        for (std::size_t i = 0; i < ring.size(); ++i)
            beside += deviation[i] * value > 0.5 * value * value &&
                      std::binary_search(row + near_.offset[v], row + near_.offset[v + 1], ring[i]);
        return beside >= alike;
    }

    Vec3 normal_around(Index v) const {
        Vec3 normal = Vec3::Zero();
        for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k)
            for (const Index f : at_[near_.vertex[k]]) normal += area_vector(faces_[f], p_);
        const double length = normal.norm();
        return length > 0 ? Vec3(normal / length) : Vec3(0, 0, 0);
    }

    const Faces& faces_;
    const Positions& p_;
    const Incidence& at_;
    const Neighbours& near_;
};

/// How high impulses are at most, by those in the quietest third of the surface; 0 if there are none.
double highest_impulse(const Heights& heights, Index count) {
    const Index step = std::max<Index>(1, count / looked_at);
    std::vector<Height> seen(count / step);
    parallel_for(static_cast<Index>(seen.size()), [&](Index i) { seen[i] = heights.over_quadric(i * step); });
    seen.erase(std::remove_if(seen.begin(), seen.end(), [](const Height& h) { return !(h.usual > 0); }), seen.end());
    const std::size_t third = seen.size() / 3;
    std::nth_element(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(third), seen.end(),
                     [](const Height& a, const Height& b) { return a.usual < b.usual; });
    std::vector<double> high;
    double balance = 0;
    for (std::size_t i = 0; i < third; ++i) {
        if (!seen[i].above(certain)) continue;
        high.push_back(std::abs(seen[i].value));
        balance += seen[i].value > 0 ? 1 : -1;
    }
    const auto found = static_cast<double>(high.size());
    if (high.size() < least_count || found < impulsive * static_cast<double>(third)) return 0;
    if (std::abs(balance) > lopsided * std::sqrt(found)) return 0;
    const double most_high = *std::max_element(high.begin(), high.end());
    return std::min(highest_of_median * lower_quantile(high, 0.5), highest_of_most * most_high);
}

}  // namespace

Positions without_weak_impulses(const Faces& faces, const Positions& positions, const Incidence& at,
                                const Neighbours& near, double& highest) {
    highest = highest_impulse(Heights(faces, positions, at, near), near.rows());
    if (!(highest > 0)) return positions;
    Positions p = positions, next = positions;
    for (int pass = 0; pass < passes; ++pass) {
        const Heights heights(faces, p, at, near);
        parallel_for(near.rows(), [&](Index v) {
            const Height h = heights.over_quadric(v);
            const bool is_impulse = h.above(likely) && std::abs(h.value) <= highest;
            next[v] = is_impulse ? Vec3(p[v] - h.value * h.normal) : p[v];
        });
        p.swap(next);
    }
    return p;
}

Positions without_impulses_beside_creases(const Faces& faces, const Positions& positions, const Incidence& at,
                                          const Neighbours& near, double highest) {
    Positions p = positions;
    const Heights heights(faces, positions, at, near);
    parallel_for(near.rows(), [&](Index v) {
        const Vec3 move = to_crease(faces, positions, at, near, v);
        if (move.squaredNorm() > 0) {
            if (move.norm() <= highest) p[v] += move;
            return;
        }
        const Height h = heights.over_plane(v);
        if (h.above(certain) && std::abs(h.value) <= highest) p[v] -= h.value * h.normal;
    });
    return p;
}

}  // namespace multires
