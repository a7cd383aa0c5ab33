#include "operators/plane_interpolation.h"

#include "base/decompositions.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace multires::kernels {

/// Puts the ring into its plane.
bool PlaneInterpolation::project(const StarGeometry& star) {
    const Index n = star.size;
    ring_ = n;
    entry_.clear();
    if (n > most) return false;
    Vec3 mean(0, 0, 0);
    for (Index k = 0; k < n; ++k) mean += Vec3(star.x[k], star.y[k], star.z[k]);
    mean /= n;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (Index k = 0; k < n; ++k) {
        const Vec3 d = Vec3(star.x[k], star.y[k], star.z[k]) - mean;
        spread += d * d.transpose();
    }
    const double size = spread.trace();
    if (!(size > 0) || !std::isfinite(1 / size)) return false;
    const auto [square, axes] = principal_axes(spread / size);  // ascending, sum 1
    if (!(square[1] > 1e-10) || square[0] > (1 - 1e-6) * square[1]) return false;
    const double scale = std::sqrt(n / size);
    for (int a = 0; a < 2; ++a) {
        axis_[a] = scale * axes.col(2 - a);
        spread_[a] = n * square[2 - a];
    }
    sites_.resize(n);
    for (Index k = 0; k < n; ++k) {
        const Vec3 spoke(star.x[k], star.y[k], star.z[k]);
        sites_[k] = {axis_[0].dot(spoke), axis_[1].dot(spoke)};
    }
    middle_ = {axis_[0].dot(mean), axis_[1].dot(mean)};
    return true;
}

/// Adds to the ring's weights, by the least sum of squares, what makes all sum to 1 and their sites to the foot.
void PlaneInterpolation::make_linear(const Flaps* flaps, double* weight) const {
    const auto weight_of = [&](std::size_t k) {
        return k < static_cast<std::size_t>(ring_) ? weight[k] : flaps->weight[entry_[k - ring_]];
    };
    double missing = 1, x = 0, y = 0;
    for (std::size_t k = 0; k < sites_.size(); ++k) {
        const double w = weight_of(k);
        missing -= w, x += w * sites_[k].x, y += w * sites_[k].y;
    }
    x += missing * middle_.x, y += missing * middle_.y;
    const double along = x / spread_[0], across = y / spread_[1];
    for (Index k = 0; k < ring_; ++k)
        weight[k] += missing / ring_ - along * (sites_[k].x - middle_.x) - across * (sites_[k].y - middle_.y);
}

/// Cuts off the part where line[0] x + line[1] y > line[2].
void PlaneInterpolation::clip(Polygon& polygon, Polygon& scratch, const std::array<double, 3>& line, Index side) {
    scratch.clear();
    const auto beyond = [&](const Corner& c) { return line[0] * c.x + line[1] * c.y - line[2]; };
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Corner &a = polygon[k], &b = polygon[k + 1 < polygon.size() ? k + 1 : 0];
        const double da = beyond(a), db = beyond(b);
        if (da <= 0) scratch.push_back(a);
        if ((da <= 0) == (db <= 0)) continue;
        const double t = da / (da - db);
        scratch.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), da <= 0 ? side : a.side});
    }
    polygon.swap(scratch);
}

double PlaneInterpolation::area(const Polygon& polygon) {
    double sum = 0;
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
        const Corner &o = polygon[0], &a = polygon[k], &b = polygon[k + 1];
        sum += (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
    }
    return sum;
}

/// The Voronoi cell of the foot among the sites; false if it has no end.
bool PlaneInterpolation::cell() {
    constexpr double end = 1e4;  // in sizes of the ring: the foot is a ten-thousandth from the hull then
    cell_ = {{-end, -end, -1}, {end, -end, -1}, {end, end, -1}, {-end, end, -1}};
    for (Index k = 0; k < ring_; ++k) {
        const Point& q = sites_[k];
        clip(cell_, scratch_, {q.x, q.y, 0.5 * (q.x * q.x + q.y * q.y)}, k);
    }
    return std::all_of(cell_.begin(), cell_.end(), [](const Corner& c) { return c.side >= 0; });
}

bool PlaneInterpolation::natural_neighbours(const StarGeometry& star, double* weight) {
    if (!project(star)) return false;
    constexpr double none = 1e-24;  // squared distance of points that coincide
    const auto square = [&](const Point& a, const Point& b) {
        return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
    };
    const auto at_foot = std::count_if(sites_.begin(), sites_.end(), [&](const Point& q) {
        return square(q, {0, 0}) <= none;
    });
    std::fill_n(weight, ring_, 1.0 / ring_);
    if (at_foot > 0) {
        for (Index k = 0; k < ring_; ++k)
            weight[k] = square(sites_[k], {0, 0}) <= none ? 1.0 / static_cast<double>(at_foot) : 0;
    } else if (cell()) {
        std::fill_n(weight, ring_, 0.0);
        double sum = 0;
        for (std::size_t at = 0; at < cell_.size(); ++at) {
            const Index k = cell_[at].side;
            if (weight[k] > 0) continue;  // rounding has cut one side in two
            part_ = cell_;
            for (const Corner& corner : cell_) {
                const Point &q = sites_[k], &other = sites_[corner.side];
                if (square(q, other) <= none) continue;
                const double more = other.x * other.x + other.y * other.y - q.x * q.x - q.y * q.y;
                clip(part_, scratch_, {other.x - q.x, other.y - q.y, 0.5 * more}, -1);
            }
            weight[k] = area(part_);
            sum += weight[k];
        }
        if (!(sum > 0)) return false;
        for (Index k = 0; k < ring_; ++k) weight[k] /= sum;
    }
    make_linear(nullptr, weight);
    return true;
}

void PlaneInterpolation::add_flaps(const Star& rows, const Flaps& flaps) {
    const auto named_before = [&](Index entry) {
        const Index v = flaps.vertex[entry];
        return v == rows.vertex || std::find(rows.neighbor, rows.neighbor + ring_, v) != rows.neighbor + ring_ ||
               std::find(flaps.vertex, flaps.vertex + entry, v) != flaps.vertex + entry;
    };
    for (Index j = 0; j < ring_; ++j) {
        if (named_before(j)) continue;
        const Vec3 d = (*flaps.positions)[flaps.vertex[j]] - flaps.center;
        const Point q{axis_[0].dot(d), axis_[1].dot(d)};
        const bool near = std::any_of(sites_.begin(), sites_.end(),
                                      [&](const Point& p) { return std::hypot(p.x - q.x, p.y - q.y) < 1e-3; });
        if (near) continue;
        sites_.push_back(q);
        entry_.push_back(j);
    }
}

bool PlaneInterpolation::thin_plate(const StarGeometry& star, const Star& rows, const Flaps* flaps, double* weight) {
    if (!project(star)) return false;
    if (flaps != nullptr) {
        std::fill_n(flaps->weight, ring_, 0.0);
        add_flaps(rows, *flaps);
    }
    // The spline of the values f at the sites q_k has the coefficients A^-1 (f, 0, 0, 0), where A holds the radial
    // functions and the linear ones; its value at the foot is linear in f, and A is symmetric: the weights are the
    // first entries of A^-1 (radial functions and linear ones at the foot).
    const Index n = static_cast<Index>(sites_.size());
    const auto radial = [](double square) { return square > 0 ? square * std::log(square) : 0; };
    matrix_.resize(static_cast<std::size_t>(n + 3) * (n + 3));
    right_.resize(n + 3);
    Eigen::Map<Eigen::MatrixXd> a(matrix_.data(), n + 3, n + 3);
    Eigen::Map<Eigen::VectorXd> b(right_.data(), n + 3);
    for (Index i = 0; i < n; ++i) {
        const Point& p = sites_[i];
        for (Index j = 0; j < i; ++j) {
            const double x = sites_[j].x - p.x, y = sites_[j].y - p.y, square = x * x + y * y;
            if (square < 1e-6) return false;
            a(i, j) = a(j, i) = radial(square);
        }
        a(i, i) = 0;
        a(i, n) = a(n, i) = 1;
        a(i, n + 1) = a(n + 1, i) = p.x;
        a(i, n + 2) = a(n + 2, i) = p.y;
        b[i] = radial(p.x * p.x + p.y * p.y);
    }
    a.bottomRightCorner(3, 3).setZero();
    b.tail(3) = Vec3(1, 0, 0);
    const Eigen::PartialPivLU<Eigen::Ref<Eigen::MatrixXd>> lu(a);
    b = lu.solve(b).eval();
    std::copy_n(right_.data(), ring_, weight);
    for (Index k = ring_; k < n; ++k) flaps->weight[entry_[k - ring_]] = right_[k];
    make_linear(flaps, weight);
    return true;
}

}  // namespace multires::kernels
