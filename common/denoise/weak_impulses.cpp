#include "denoise/weak_impulses.h"

#include "base/median.h"
#include "base/parallel.h"
#include "denoise/least_deviations.h"
#include "measure/vertex_normals.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr std::size_t least_points = 9, most_points = 64;  ///< half as many again as a quadric has to be chosen
constexpr int rounds = 6;
constexpr double smallest = 1e-3;                  ///< deviation that counts, of the largest
constexpr double most = 0.75, least_usual = 1e-3;  ///< share of the deviations that are usual; mean distance around
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

/// A vertex above what those around predict.
struct Height {
    double value = 0, usual = 0;  ///< usual is 0 where nothing is known, or it is not alone
    Vec3 normal = Vec3::Zero();
    bool above(double times) const { return usual > 0 && std::abs(value) > times * usual; }
};

/// The value of the quadric at the origin.
/// @param[out] deviation  #values: from it
double quadric_at_origin(const std::vector<Quadric>& terms, const std::vector<double>& values,
                         std::vector<double>& deviation) {
    deviation.assign(values.size(), 1);
    Quadric fit = Quadric::Zero();
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

    Height operator()(Index v) const {
        Height height;
        std::vector<Index> ring;
        if (!near_.rim[v]) two_rings(near_, v, ring);
        if (ring.size() < least_points || ring.size() > most_points) return height;
        height.normal = normal_around(v);
        double unit = 0;
        for (const Index w : ring) unit += (p_[w] - p_[v]).norm() / static_cast<double>(ring.size());
        if (!(height.normal.squaredNorm() > 0 && unit > 0)) return height;
        const Vec3 first = height.normal.unitOrthogonal(), second = height.normal.cross(first);
        std::vector<Quadric> terms;
        std::vector<double> values, deviation;
        for (const Index w : ring) {
            const Vec3 d = (p_[w] - p_[v]) / unit;
            const double x = d.dot(first), y = d.dot(second);
            terms.emplace_back();
            terms.back() << 1, x, y, x * x, x * y, y * y;
            values.push_back(d.dot(height.normal));
        }
        height.value = -unit * quadric_at_origin(terms, values, deviation);
        if (goes_on(v, height.value / unit, ring, deviation)) return height;
        for (double& d : deviation) d = std::abs(d);
        height.usual = unit * std::max(least_usual, lower_quantile(deviation, most));
        return height;
    }

private:
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
    parallel_for(static_cast<Index>(seen.size()), [&](Index i) { seen[i] = heights(i * step); });
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
                                const Neighbours& near) {
    const double highest = highest_impulse(Heights(faces, positions, at, near), near.rows());
    if (!(highest > 0)) return positions;
    Positions p = positions, next = positions;
    for (int pass = 0; pass < passes; ++pass) {
        const Heights heights(faces, p, at, near);
        parallel_for(near.rows(), [&](Index v) {
            const Height h = heights(v);
            const bool is_impulse = h.above(likely) && std::abs(h.value) <= highest;
            next[v] = is_impulse ? Vec3(p[v] - h.value * h.normal) : p[v];
        });
        p.swap(next);
    }
    return p;
}

}  // namespace multires
