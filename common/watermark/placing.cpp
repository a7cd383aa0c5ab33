#include "watermark/placing.h"

#include "base/decompositions.h"
#include "base/median.h"
#include "base/parallel.h"
#include "measure/distance.h"
#include "measure/measure.h"
#include "measure/vertex_normals.h"
#include "mesh/validation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace multires {
namespace {

using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Vector7 = Eigen::Matrix<double, 7, 1>;

/// Every k-th vertex that a face has.
Positions some_vertices(const Mesh& mesh, std::size_t most) {
    const std::vector<std::uint8_t> used = vertices_in_faces(mesh);
    Positions all;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i]) all.push_back(mesh.positions[i]);
    Positions some;
    const std::size_t count = std::min(most, all.size());
    for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
    return some;
}

/// Centroid, size and axes of a surface.
struct Moments {
    Vec3 centre = Vec3::Zero();
    double size = 0;  ///< root of the mean square distance from the centre
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();

    explicit Moments(const Mesh& mesh) {
        centre = surface(mesh.faces, mesh.positions).centroid;
        Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
        double area = 0;
        for (const Face& f : mesh.faces) {
            const double a = area_vector(f, mesh.positions).norm() / 2;
            area += a;
            Vec3 sum = Vec3::Zero();
            for (const Index v : f) {  // exact: (9 m m' + sum of p p') / 12 with m the mean of the corners
                const Vec3 p = mesh.positions[v] - centre;
                sum += p;
                squares += a / 12 * p * p.transpose();
            }
            squares += a / 12 * sum * sum.transpose();
        }
        if (!(area > 0)) return;
        squares /= area;
        size = std::sqrt(squares.trace());
        axes = principal_axes(squares).vectors;
        if (axes.determinant() < 0) axes.col(0) *= -1;
    }
};

/// The 24 rotations that take the axes to each other.
std::vector<Eigen::Matrix3d> quarter_turns() {
    std::vector<Eigen::Matrix3d> all;
    std::array<int, 3> axis{0, 1, 2};
    do {
        for (int signs = 0; signs < 8; ++signs) {
            Eigen::Matrix3d r = Eigen::Matrix3d::Zero();
            for (int k = 0; k < 3; ++k) r(k, axis[k]) = signs >> k & 1 ? -1 : 1;
            if (r.determinant() > 0) all.push_back(r);
        }
    } while (std::next_permutation(axis.begin(), axis.end()));
    return all;
}

std::vector<Eigen::Affine3d> starts(const Mesh& mesh, const Mesh& onto) {
    std::vector<Eigen::Affine3d> all;
    if (mesh.faces == onto.faces && mesh.positions.size() == onto.positions.size()) {
        const auto columns = [](const Positions& p) {
            return Eigen::Map<const Eigen::Matrix3Xd>(p[0].data(), 3, static_cast<Eigen::Index>(p.size()));
        };
        all.push_back(least_squares_similarity(columns(mesh.positions), columns(onto.positions)));
    }
    all.push_back(Eigen::Affine3d::Identity());
    const Moments from(mesh), to(onto);
    if (!(from.size > 0) || !(to.size > 0)) return all;
    for (const Eigen::Matrix3d& turn : quarter_turns()) {
        Eigen::Affine3d t = Eigen::Affine3d::Identity();
        t.linear() = to.size / from.size * to.axes * turn * from.axes.transpose();
        t.translation() = to.centre - t.linear() * from.centre;
        all.push_back(t);
    }
    return all;
}

/// Iterated closest points of some vertices.
class Fit {
public:
    Fit(const Positions& points, const Mesh& onto, const SurfaceTree& tree)
        : points_(points), onto_(onto), tree_(tree), hint_(points.size(), -1), residual_(points.size()),
          row_(points.size()) {
        unit_ = bounding_box(onto.positions).diagonal();
    }

    /// Improves a placement; what is left of the distances, in parts of the size of `onto`.
    double improve(Eigen::Affine3d& t, int steps) {
        const double scale = size(t);
        for (int step = 0; step < steps; ++step) {
            measure(t);
            const Vector7 change = solved();
            Eigen::Affine3d by = Eigen::Affine3d::Identity();
            const Vec3 turn = change.head<3>();
            if (turn.norm() > 0) by.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
            by.linear() *= std::exp(change[6]);
            const Eigen::Affine3d next =
                Eigen::Translation3d(centre_ + unit_ * change.segment<3>(3)) * by * Eigen::Translation3d(-centre_) * t;
            const double ratio = size(next) / scale;
            if (!(ratio > 0.7 && ratio < 1.4)) break;  // shrinking to a point would bring everything near
            t = next;
            if (change.norm() < 1e-8) break;
        }
        measure(t);
        return left();
    }

private:
    static double size(const Eigen::Affine3d& t) { return std::cbrt(std::abs(t.linear().determinant())); }

    /// Distances along the normals of the closest faces and how they change with a turn, a shift and a scaling.
    void measure(const Eigen::Affine3d& t) {
        centre_ = Vec3::Zero();
        for (const Vec3& p : points_) centre_ += t * p;
        centre_ /= static_cast<double>(points_.size());
        parallel_for(
            static_cast<Index>(points_.size()),
            [&](Index i) {
                const Vec3 p = t * points_[i], arm = (p - centre_) / unit_;
                const SurfaceTree::Hit hit = tree_.closest(p, hint_[i]);
                hint_[i] = hit.face;
                Vec3 normal = area_vector(onto_.faces[hit.face], onto_.positions).normalized();
                const double along = normal.dot(p - hit.point) / unit_;
                residual_[i] = {along, std::sqrt(hit.squared) / unit_};
                row_[i] << arm.cross(normal), normal, arm.dot(normal);
            },
            64);
    }

    /// Least squares with the weights of Cauchy's distribution, so that a part that is not there counts little.
    Vector7 solved() const {
        std::vector<double> size;
        for (const auto& r : residual_) size.push_back(r.second);
        const double usual = std::max(2 * upper_median(size), 1e-12);
        Matrix7 a = Matrix7::Zero();
        Vector7 b = Vector7::Zero();
        for (std::size_t i = 0; i < row_.size(); ++i) {
            const double far = residual_[i].second / usual, w = 1 / (1 + far * far);
            a += w * row_[i] * row_[i].transpose();
            b -= w * residual_[i].first * row_[i];
        }
        a.diagonal().array() += 1e-9 * std::max(a.trace(), 1e-300);  // a plane can slide, a sphere turn
        return solve_symmetric(a, b);
    }

    /// Mean distance, those beyond a twentieth of the size counting as that.
    double left() const {
        double sum = 0;
        for (const auto& r : residual_) sum += std::min(r.second, 0.05);
        return sum / static_cast<double>(residual_.size());
    }

    const Positions& points_;
    const Mesh& onto_;
    const SurfaceTree& tree_;
    std::vector<Index> hint_;
    std::vector<std::pair<double, double>> residual_;  // along the normal, and the distance
    std::vector<Vector7> row_;
    Vec3 centre_ = Vec3::Zero();
    double unit_ = 1;
};

}  // namespace

Eigen::Affine3d similarity_onto(const Mesh& mesh, const Mesh& onto, const SurfaceTree& tree) {
    const Positions few = some_vertices(mesh, 150), more = some_vertices(mesh, 400);
    std::vector<Eigen::Affine3d> all = starts(mesh, onto);
    std::vector<double> left, sorted;
    for (Eigen::Affine3d& t : all) left.push_back(Fit(few, onto, tree).improve(t, 8));
    sorted = left;
    constexpr std::size_t finalists = 5;
    std::nth_element(sorted.begin(), sorted.begin() + std::min(finalists, sorted.size()) - 1, sorted.end());
    const double enough = sorted[std::min(finalists, sorted.size()) - 1];
    Eigen::Affine3d best = Eigen::Affine3d::Identity();
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (left[k] > enough && k > 1) continue;
        const double now = Fit(more, onto, tree).improve(all[k], 15);
        if (now < 0.8 * nearest) nearest = now, best = all[k];
    }
    return best;
}

double refine_placement(const Mesh& mesh, const Mesh& onto, const SurfaceTree& tree, Eigen::Affine3d& placement,
                        const Refinement& how) {
    const Positions some = some_vertices(mesh, how.vertices);
    return Fit(some, onto, tree).improve(placement, how.steps);
}

}  // namespace multires
