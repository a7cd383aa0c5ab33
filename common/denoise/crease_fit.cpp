#include "denoise/crease_fit.h"

#include "base/median.h"
#include "measure/vertex_normals.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>

namespace multires {
namespace {

constexpr std::size_t least_points = 9, most_points = 64;
constexpr std::size_t least_on_side = 5;  ///< two more than a plane has to be chosen
constexpr int rounds = 6;
constexpr double smallest = 1e-3;                  ///< deviation that counts, of the largest
constexpr double shallow = 0.5;                    ///< sine of the angle between the sides: no certain place
constexpr double most = 0.75, least_usual = 1e-3;  ///< share that is usual; the least, of the mean distance around
constexpr double on = 4, off = 8;                  ///< times what is usual

struct Plane {
    Vec3 at = Vec3::Zero(), normal = Vec3::Zero();
    double above(const Vec3& x) const { return normal.dot(x - at); }
};

using Sides = std::array<std::vector<Index>, 2>;

void keep_once(std::vector<Index>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// Whether the vertex' own faces have different normals: most vertices need no closer look.
template <class Star>
bool bends(const Faces& faces, const Positions& p, const Star& star) {
    Vec3 first = Vec3::Zero();
    for (const Index f : star) {
        const Vec3 area = area_vector(faces[f], p);
        if (first.cross(area).norm() > shallow * first.norm() * area.norm()) return true;
        if (first.squaredNorm() == 0) first = area;
    }
    return false;
}

/// Faces of vertices of the ring alone.
std::vector<Index> faces_within(const Faces& faces, const Incidence& at, const std::vector<Index>& ring) {
    std::vector<Index> within;
    const auto inside = [&](Index w) { return std::binary_search(ring.begin(), ring.end(), w); };
    for (const Index w : ring)
        for (const Index f : at[w])
            if (std::all_of(faces[f].begin(), faces[f].end(), inside)) within.push_back(f);
    keep_once(within);
    return within;
}

/// The vertices of the faces to either side; false if there is no crease.
bool two_sides(const Faces& faces, const Positions& p, const std::vector<Index>& around, Sides& sides) {
    if (around.size() < least_points) return false;
    std::vector<Vec3> normals;
    Vec3 mean = Vec3::Zero();
    for (const Index f : around) {
        const Vec3 area = area_vector(faces[f], p);
        const double length = area.norm();
        normals.push_back(length > 0 ? Vec3(area / length) : Vec3(0, 0, 0));
        mean += normals.back() / static_cast<double>(around.size());
    }
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Vec3& n : normals) spread += (n - mean) * (n - mean).transpose();
    const Vec3 across = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
    std::array<Vec3, 2> sum{Vec3::Zero(), Vec3::Zero()};
    for (std::size_t i = 0; i < around.size(); ++i) {
        const std::size_t side = (normals[i] - mean).dot(across) > 0 ? 1 : 0;
        sum[side] += normals[i];
        sides[side].insert(sides[side].end(), faces[around[i]].begin(), faces[around[i]].end());
    }
    for (auto& side : sides) keep_once(side);
    return std::min(sides[0].size(), sides[1].size()) >= least_on_side &&
           sum[0].cross(sum[1]).norm() > shallow * sum[0].norm() * sum[1].norm();
}

/// Of least absolute deviations.
Plane plane_of(const Positions& p, const std::vector<Index>& side) {
    Plane plane;
    std::vector<double> deviation(side.size(), 1);
    for (int round = 0; round < rounds; ++round) {
        double largest = 0, sum = 0;
        for (const double d : deviation) largest = std::max(largest, std::abs(d));
        if (!(largest > 0)) break;
        Vec3 middle = Vec3::Zero();
        for (double& d : deviation) {
            d = 1 / std::max(std::abs(d), smallest * largest);  // weights from here on
            sum += d;
        }
        for (std::size_t i = 0; i < side.size(); ++i) middle += deviation[i] / sum * p[side[i]];
        Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
        for (std::size_t i = 0; i < side.size(); ++i)
            spread += deviation[i] / sum * (p[side[i]] - middle) * (p[side[i]] - middle).transpose();
        plane = {middle, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0)};
        for (std::size_t i = 0; i < side.size(); ++i) deviation[i] = plane.above(p[side[i]]);
    }
    return plane;
}

}  // namespace

Vec3 to_crease(const Faces& faces, const Positions& p, const Incidence& at, const Neighbours& near, Index v) {
    std::vector<Index> ring;
    if (!near.rim[v] && bends(faces, p, at[v])) two_rings(near, v, ring);
    if (ring.size() < least_points || ring.size() > most_points) return Vec3::Zero();
    Sides sides;
    if (!two_sides(faces, p, faces_within(faces, at, ring), sides)) return Vec3::Zero();
    const Plane a = plane_of(p, sides[0]), b = plane_of(p, sides[1]);
    const double cosine = a.normal.dot(b.normal), squared_sine = 1 - cosine * cosine;
    if (!(squared_sine > shallow * shallow)) return Vec3::Zero();

    double unit = 0;
    std::vector<double> deviation;
    for (const Index w : ring) {
        unit += (p[w] - p[v]).norm() / static_cast<double>(ring.size());
        deviation.push_back(std::min(std::abs(a.above(p[w])), std::abs(b.above(p[w]))));
    }
    const double usual = std::max(least_usual * unit, lower_quantile(deviation, most));
    const double over_a = a.above(p[v]), over_b = b.above(p[v]);
    if (std::min(std::abs(over_a), std::abs(over_b)) <= off * usual) return Vec3::Zero();
    bool only_a = false, only_b = false;
    for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) {
        const Vec3& beside = p[near.vertex[k]];
        const double from_a = std::abs(a.above(beside)), from_b = std::abs(b.above(beside));
        only_a = only_a || (from_a <= on * usual && from_b > off * usual);
        only_b = only_b || (from_b <= on * usual && from_a > off * usual);
    }
    if (!only_a || !only_b) return Vec3::Zero();
    return ((over_b * cosine - over_a) * a.normal + (over_a * cosine - over_b) * b.normal) / squared_sine;
}

}  // namespace multires
