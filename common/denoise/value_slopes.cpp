#include "denoise/value_slopes.h"

#include "base/median.h"
#include "base/parallel.h"
#include "denoise/least_deviations.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr std::size_t least_points = 6;  ///< twice what a plane has to be chosen
constexpr int rounds = 6;
constexpr double smallest = 1e-3;  ///< deviation that counts, of the largest

/// Slope over two coordinates of the plane nearest to the values.
/// @param at  #values: 1 and the coordinates, of about unit size
Eigen::Vector2d slope_of_plane(const std::vector<Vec3>& at, std::vector<double> values) {
    std::vector<double> deviation = values;
    const double middle = lower_quantile(deviation, 0.5);
    double most = 0;
    for (double& value : values) {
        value -= middle;
        most = std::max(most, std::abs(value));
    }
    Vec3 plane = Vec3::Zero();
    deviation = values;
    for (int round = 0; round < rounds && most > 0; ++round)
        plane = towards_least_deviations(at, values, deviation, smallest * most);
    return plane.tail<2>();
}

}  // namespace

std::vector<Vec3> value_slopes(const Neighbours& near, const Positions& positions, const Positions& normals,
                               const std::vector<double>& values, int width) {
    std::vector<Vec3> slope(values.size(), Vec3::Zero());
    parallel_for(near.rows(), [&](Index v) {
        if (near.size(v) > most_around) return;
        std::vector<Index> ring;
        two_rings(near, v, ring);
        if (ring.size() < least_points) return;
        const Vec3 u = normals[v].unitOrthogonal(), w = normals[v].cross(u);
        std::vector<Vec3> at;
        double unit = 0;
        for (const Index k : ring) {
            const Vec3 d = positions[k] - positions[v];
            at.emplace_back(1, d.dot(u), d.dot(w));
            unit += d.norm() / static_cast<double>(ring.size());
        }
        if (!(unit > 0)) return;
        for (Vec3& p : at) p.tail<2>() /= unit;
        std::vector<double> around(ring.size());
        for (int c = 0; c < width; ++c) {
            for (std::size_t i = 0; i < ring.size(); ++i)
                around[i] = values[static_cast<std::size_t>(ring[i]) * width + c];
            const Eigen::Vector2d g = slope_of_plane(at, around) / unit;
            slope[static_cast<std::size_t>(v) * width + c] = g[0] * u + g[1] * w;
        }
    });
    return slope;
}

}  // namespace multires
