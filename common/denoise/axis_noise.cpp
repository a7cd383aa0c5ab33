#include "denoise/axis_noise.h"

#include "base/decompositions.h"
#include "base/parallel.h"
#include "base/reduce.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace multires {
namespace {

constexpr int local_steps = 2;          ///< averaging that makes energies local
constexpr int expected_steps = 20;      ///< more of it for those of white noise: a property of the mesh alone
constexpr double least_share = 0.05;    ///< of the mean energy: what is less counts no more than this
constexpr double stands_out = 1.8;      ///< of the deviation along the axis, to that in the next direction
constexpr double faced = 0.1;           ///< mean squared cosine of the normals to the axis, at least
constexpr double off_one = 0.5;         ///< of the share of the noise that the places within the surface show, at most
constexpr double least_evidence = 4.5;  ///< of that share, in standard errors

constexpr int width = 6;  ///< of a covariance: xx, yy, zz, xy, xz, yz
using Row = Eigen::Matrix<double, width, 1>;
using Square = Eigen::Matrix<double, width, width>;
using Three = Eigen::Matrix<double, 3, width>;

/// C n, linear in the six numbers of C.
Three times(const Vec3& n) {
    Three m = Three::Zero();
    m.diagonal() = n;
    for (const auto& [column, i, j] : {std::array{3, 0, 1}, std::array{4, 0, 2}, std::array{5, 1, 2}}) {
        m(i, column) = n[j];
        m(j, column) = n[i];
    }
    return m;
}

Positions third_detail(const Neighbours& near, Positions p) {
    for (int order = 0; order < 3; ++order) p = detail_of(near, p);
    return p;
}

/// Products of third details' parts along the normal and in all directions, with their weights.
struct Products {
    std::vector<Vec3> product;          ///< of the vertices `inner`: what C n is expected to be
    std::vector<double> along, within;  ///< weights of its parts along the normal, and within the surface
    /// So much of the true mean is the weighted one, for weights are less where a sample of noise happens to be large.
    double factor = 1;
};

Products products(const Neighbours& near, const Positions& p, const Array<Vec3>& normal,
                  const std::vector<Index>& inner) {
    Positions noise(p.size());
    parallel_for(near.rows(), [&](Index v) { noise[v] = Vec3(gaussian(v, 5), gaussian(v, 6), gaussian(v, 7)); });
    const Positions detail = third_detail(near, p);
    noise = third_detail(near, std::move(noise));
    std::vector<double> energy(3 * p.size()), expected(p.size());  // along the normal, within the surface, of noise
    parallel_for(near.rows(), [&](Index v) {
        const double along = normal[v].dot(detail[v]);
        energy[3 * v] = along * along;
        energy[3 * v + 1] = std::max(0.0, detail[v].squaredNorm() - along * along) / 2;
        energy[3 * v + 2] = noise[v].x() * noise[v].x();
        expected[v] = noise[v].squaredNorm() / 3;
    });
    average(near, energy, 3, local_steps);
    average(near, expected, 1, local_steps + expected_steps);
    Products out;
    out.product.resize(inner.size());
    out.along.resize(inner.size());
    out.within.resize(inner.size());
    double mean = 0, weights = 0, product = 0;
    for (const Index v : inner)
        if (expected[v] > 0) mean += energy[3 * v] / expected[v] / static_cast<double>(inner.size());
    for (std::size_t i = 0; i < inner.size(); ++i) {
        const Index v = inner[i];
        if (!(expected[v] > 0)) continue;
        const auto of = [&](int c, double floor) { return energy[3 * v + c] / expected[v] + least_share * floor; };
        out.product[i] = normal[v].dot(detail[v]) / expected[v] * detail[v];
        out.along[i] = 1 / std::pow(of(0, mean), 2);
        out.within[i] = 1 / (of(0, mean) * of(1, mean));
        const double weight = 1 / std::pow(of(2, 1), 2);
        weights += weight;
        product += weight * noise[v].x() * noise[v].x() / expected[v];
    }
    if (weights > 0) out.factor = product / weights;
    return out;
}

/// Normal equations of C.
struct Equations {
    Square matrix = Square::Zero();
    Row right = Row::Zero();
    Equations& operator+=(const Equations& o) {
        matrix += o.matrix;
        right += o.right;
        return *this;
    }
};

/// The same noise in all directions, and more along an axis.
struct Covariance {
    PrincipalAxes axes;
    double across() const { return std::max(0.0, axes.values[1]); }
    double more() const { return axes.values[2] - across(); }
    Vec3 axis() const { return axes.vectors.col(2); }
    Row row() const {
        const Vec3 a = axis();
        Row c;
        c << a.x() * a.x(), a.y() * a.y(), a.z() * a.z(), a.x() * a.y(), a.x() * a.z(), a.y() * a.z();
        c *= more();
        c.head<3>().array() += across();
        return c;
    }
};

/// By least squares. What no normal tells of, such as the variance along a tube, is filled in as it is where there is
/// noise along an axis.
Covariance covariance_of(const Products& of, const Array<Vec3>& normal, const std::vector<Index>& inner) {
    constexpr double filled = 1e-3;
    constexpr int fillings = 20;
    Equations all = chunked_fold<Equations>(inner.size(), [&](Equations& part, std::size_t i) {
        const Vec3& n = normal[static_cast<std::size_t>(inner[i])];
        const Eigen::Matrix3d weight =
            (of.along[i] - of.within[i]) * n * n.transpose() + of.within[i] * Eigen::Matrix3d::Identity();
        const Three row = times(n);
        part.matrix += row.transpose() * weight * row;
        part.right += row.transpose() * (weight * of.product[i]);
    });
    all.right /= of.factor;
    const double weight = filled / width * all.matrix.trace();
    all.matrix.diagonal().array() += weight;
    Covariance found;
    for (int filling = 0; filling < fillings; ++filling) {
        Row right = all.right;
        if (filling > 0) right += weight * found.row();
        const Row c = solve_symmetric(all.matrix, right);
        Eigen::Matrix3d covariance;
        covariance << c[0], c[3], c[4], c[3], c[1], c[5], c[4], c[5], c[2];
        if (!covariance.allFinite()) return Covariance{{Vec3::Zero(), Eigen::Matrix3d::Identity()}};
        found.axes = principal_axes(covariance);
    }
    return found;
}

/// Noise along an axis crosses the surface as far as what is seen of it along the normals tells: the share of that
/// which third differences within the surface show. It is 1 for such noise, about 0 for any other.
struct Crossing {
    double product = 0, square = 0, squares = 0;
    Crossing& operator+=(const Crossing& o) {
        product += o.product;
        square += o.square;
        squares += o.squares;
        return *this;
    }
    double share() const { return square > 0 ? product / square : 0; }
    double evidence() const { return squares > 0 ? product / std::sqrt(squares) : 0; }  ///< standard errors
};

/// @param more  variance along the axis beyond that in other directions
Crossing crossing(const Products& of, const Vec3& axis, double more, const Array<Vec3>& normal,
                  const std::vector<Index>& inner) {
    return chunked_fold<Crossing>(inner.size(), [&](Crossing& part, std::size_t i) {
        const Vec3& n = normal[static_cast<std::size_t>(inner[i])];
        const double facing = n.dot(axis);
        const Vec3 expected = of.factor * more * facing * (axis - facing * n);
        const double product = of.within[i] * expected.dot(of.product[i]);
        part.product += product;
        part.square += of.within[i] * expected.squaredNorm();
        part.squares += product * product;
    });
}

/// The share of moves within the surface after which its second differences are least.
double evening_share(const Neighbours& near, const Array<Vec3>& normal, const Positions& p, const Positions& moves) {
    const Positions places = detail_of(near, detail_of(near, p)), moved = detail_of(near, detail_of(near, moves));
    double product = 0, square = 0;
    for (Index v = 0; v < near.rows(); ++v) {
        if (near.rim[v]) continue;
        const Vec3 within = moved[v] - normal[v].dot(moved[v]) * normal[v];
        product -= within.dot(places[v]);
        square += within.squaredNorm();
    }
    return square > 0 ? std::clamp(product / square, 0.0, 1.0) : 0;
}

}  // namespace

std::optional<AxisNoise> axis_noise(const Neighbours& near, const Positions& p, const Array<Vec3>& normal,
                                    const std::vector<Index>& inner) {
    const Products of = products(near, p, normal, inner);
    const Covariance covariance = covariance_of(of, normal, inner);
    const double along = covariance.axes.values[2], across = covariance.across();
    if (!(along > stands_out * stands_out * across)) return std::nullopt;
    const Vec3 axis = covariance.axis();
    const auto mean_of = [&](const auto& value) {
        return chunked_fold<Mean>(inner.size(),
                                  [&](Mean& part, std::size_t i) {
                                      part.add(value(axis.dot(normal[static_cast<std::size_t>(inner[i])])));
                                  })
            .value();
    };
    // Nothing is known of noise that runs along the surface.
    if (mean_of([](double facing) { return facing * facing; }) < faced) return std::nullopt;
    const double one_side = std::abs(mean_of([](double facing) { return facing; })) /
                            mean_of([](double facing) { return std::abs(facing); });
    const Crossing found = crossing(of, axis, covariance.more(), normal, inner);
    if (!(std::abs(found.share() - 1) < off_one) || found.evidence() < least_evidence) return std::nullopt;
    return AxisNoise{axis, std::sqrt(along), std::sqrt(across), found.share(), one_side};
}

Sideways move_along(const AxisNoise& axis, double own, double error, const Neighbours& near, const Array<Vec3>& normal,
                    const Positions& from, Positions& to) {
    const double more = std::max(0.0, axis.deviation * axis.deviation - own * own);
    const double count = static_cast<double>(to.size());
    Positions moves(to.size(), Vec3::Zero());
    double before = 0, gain = 0;
    for (std::size_t v = 0; v < to.size(); ++v) {
        const Vec3& n = normal[v];
        const double facing = n.dot(axis.axis), variance = own * own + more * facing * facing;
        if (!(variance > 0)) continue;
        const Vec3 covariance = more * facing * (axis.axis - facing * n);  // of both parts
        const double share = 1 / (variance + error), seen = std::max(0.0, variance - error);
        moves[v] = n.dot(to[v] - from[v]) * share * covariance;
        before += more * (1 - facing * facing) / count;
        gain += covariance.squaredNorm() * seen * share * (2 / variance - share) / count;
    }
    const double share = evening_share(near, normal, from, moves);
    for (std::size_t v = 0; v < to.size(); ++v) to[v] += share * moves[v];
    return {share * before, share * (before - gain)};
}

}  // namespace multires
