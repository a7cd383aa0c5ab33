#include "denoise/value_slopes.h"

#include "base/median.h"
#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr Index most_around = 64;
constexpr std::size_t least_points = 6;  ///< twice what a plane has to be chosen
constexpr int rounds = 6;
constexpr double smallest = 1e-3;  ///< deviation that counts, of the largest

/// Slope over two coordinates of the plane nearest to the values.
/// @param at  #values: 1 and the coordinates, of about unit size
Eigen::Vector2d least_deviations(const std::vector<Vec3>& at, const std::vector<double>& values) {
    std::vector<double> deviation = values;
    const double middle = lower_quantile(deviation, 0.5);
    double most = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        deviation[i] = values[i] - middle;
        most = std::max(most, std::abs(deviation[i]));
    }
    Vec3 plane = Vec3::Zero();
    if (!(most > 0)) return plane.tail<2>();
    for (int round = 0; round < rounds; ++round) {
        Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
        Vec3 b = Vec3::Zero();
        for (std::size_t i = 0; i < values.size(); ++i) {
            const Vec3 weighted = at[i] / std::max(std::abs(deviation[i]), smallest * most);
            a += weighted * at[i].transpose();
            b += weighted * (values[i] - middle);
        }
        a.diagonal().array() += 1e-6 * a.trace();  // all on a line
        plane = a.llt().solve(b);
        for (std::size_t i = 0; i < values.size(); ++i) deviation[i] = values[i] - middle - plane.dot(at[i]);
    }
    return plane.tail<2>();
}

}  // namespace

void two_rings(const Neighbours& near, Index v, std::vector<Index>& ring) {
    const auto row = [&](Index w) { return near.vertex.begin() + near.offset[w]; };
    ring.assign(row(v), row(v + 1));
    for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k)
        if (const Index w = near.vertex[k]; near.size(w) <= most_around) ring.insert(ring.end(), row(w), row(w + 1));
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    ring.erase(std::remove(ring.begin(), ring.end(), v), ring.end());
}

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
            const Eigen::Vector2d g = least_deviations(at, around) / unit;
            slope[static_cast<std::size_t>(v) * width + c] = g[0] * u + g[1] * w;
        }
    });
    return slope;
}

}  // namespace multires
