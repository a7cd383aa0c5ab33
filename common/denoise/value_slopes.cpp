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

/// The surroundings of a vertex; allocated once for many.
struct Around {
    std::vector<Index> ring;
    std::vector<Vec3> at;  ///< #ring: 1 and the coordinates, of about unit size
    std::vector<double> values, deviation;

    /// Slope over the two coordinates of the plane nearest to the values, which are left less their median.
    Eigen::Vector2d slope_of_plane() {
        deviation = values;
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
};

}  // namespace

std::vector<Vec3> value_slopes(const Neighbours& near, const Positions& positions, const Positions& normals,
                               const std::vector<double>& values, int width) {
    std::vector<Vec3> slope(values.size(), Vec3::Zero());
    const auto find = [&](Index v, Around& around) {
        if (near.size(v) > most_around) return;
        two_rings(near, v, around.ring);
        if (around.ring.size() < least_points) return;
        const Vec3 u = normals[v].unitOrthogonal(), w = normals[v].cross(u);
        around.at.clear();
        double unit = 0;
        for (const Index k : around.ring) {
            const Vec3 d = positions[k] - positions[v];
            around.at.emplace_back(1, d.dot(u), d.dot(w));
            unit += d.norm() / static_cast<double>(around.ring.size());
        }
        if (!(unit > 0)) return;
        for (Vec3& p : around.at) p.tail<2>() /= unit;
        around.values.resize(around.ring.size());
        for (int c = 0; c < width; ++c) {
            for (std::size_t i = 0; i < around.ring.size(); ++i)
                around.values[i] = values[static_cast<std::size_t>(around.ring[i]) * width + c];
            const Eigen::Vector2d g = around.slope_of_plane() / unit;
            slope[static_cast<std::size_t>(v) * width + c] = g[0] * u + g[1] * w;
        }
    };
    parallel_chunks(near.rows(), 256, [&](Index begin, Index end) {
        Around around;
        for (Index v = begin; v < end; ++v) find(v, around);
    });
    return slope;
}

}  // namespace multires
