#include "denoise/axis_noise.h"

#include "base/decompositions.h"
#include "base/reduce.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr int local_steps = 6;        ///< averaging of the energies, and so of the directions
constexpr int reweighted = 8;         ///< steps of the fit
constexpr double explains = 0.1;      ///< share by which the deviations from the fit must fall
constexpr double by_chance = 3;       ///< by the root of #V: share of them that chance takes away
constexpr double stands_out = 2;      ///< of the deviation along the axis, to that in the next direction
constexpr double faced = 0.1;         ///< mean squared cosine of the normals to the axis, at least
constexpr double least_within = 0.5;  ///< share of the noise that the places within the surface show
constexpr double least_share = 0.05;  ///< of the mean energy: what is less counts no more than this in the fit

constexpr int columns = 7;  ///< six of the covariance, the bends
using Row = Eigen::Matrix<double, columns, 1>;
using Square = Eigen::Matrix<double, columns, columns>;

struct Equations {
    Square matrix = Square::Zero();
    Row right = Row::Zero();
    Equations& operator+=(const Equations& o) {
        matrix += o.matrix;
        right += o.right;
        return *this;
    }
};

/// The products of the normals' coordinates, averaged as the energies are, and the bends.
std::vector<Row> rows(const Neighbours& near, const Array<Vec3>& normal, const std::vector<Index>& inner,
                      const Energies& bends) {
    constexpr std::size_t width = 6;
    std::vector<double> products(width * normal.size());
    for (std::size_t v = 0; v < normal.size(); ++v) {
        const Vec3& n = normal[v];
        const std::array<double, width> p = {n.x() * n.x(),     n.y() * n.y(),     n.z() * n.z(),
                                             2 * n.x() * n.y(), 2 * n.x() * n.z(), 2 * n.y() * n.z()};
        std::copy(p.begin(), p.end(), products.begin() + static_cast<std::ptrdiff_t>(width * v));
    }
    average(near, products, width, local_steps);
    std::vector<Row> out(inner.size());
    for (std::size_t i = 0; i < inner.size(); ++i) {
        for (std::size_t c = 0; c < width; ++c)
            out[i][static_cast<Eigen::Index>(c)] = products[width * static_cast<std::size_t>(inner[i]) + c];
        out[i][columns - 1] = bends.field[i];
    }
    return out;
}

struct Fit {
    Row found = Row::Zero();
    double deviation = 0;  ///< mean size of what is not explained
};

/// @param all_directions  the same noise in all of them
Fit fitted(const std::vector<Row>& row, const std::vector<double>& energy, double mean, bool all_directions) {
    Square kept = Square::Identity();  // all directions: the trace alone
    if (all_directions) {
        kept.topLeftCorner<6, 6>().setZero();
        kept.block<3, 1>(0, 0).setOnes();
    }
    Fit fit;
    fit.found.head<3>().setConstant(mean);
    const auto explained = [&](std::size_t i) {
        return std::max(0.0, row[i].head<6>().dot(fit.found.head<6>())) +
               std::max(0.0, fit.found[columns - 1]) * row[i][columns - 1];
    };
    for (int step = 0; step < reweighted; ++step) {
        Equations all = chunked_fold<Equations>(row.size(), [&](Equations& part, std::size_t i) {
            const double weight = 1 / std::pow(explained(i) + least_share * mean, 2);
            const Row r = kept.transpose() * row[i];
            part.matrix += weight * r * r.transpose();
            part.right += weight * energy[i] * r;
        });
        all.matrix.diagonal().array() += 1e-9 * all.matrix.trace();
        fit.found = kept * solve_symmetric(all.matrix, all.right);
        if (fit.found[columns - 1] < 0) {
            all.matrix.row(columns - 1).setZero();
            all.matrix.col(columns - 1).setZero();
            all.matrix(columns - 1, columns - 1) = 1;
            all.right[columns - 1] = 0;
            fit.found = kept * solve_symmetric(all.matrix, all.right);
        }
    }
    fit.deviation = chunked_fold<Mean>(row.size(), [&](Mean& part, std::size_t i) {
                        part.add(std::abs(energy[i] - explained(i)));
                    }).value();
    return fit;
}

/// Noise along an axis crosses the surface as far as what is seen of it along the normals tells: the share of that
/// which third differences within the surface show. It is 1 for such noise, about 0 for any other. Weighed by the
/// variances along the normals, for where there is little of it hardly anything is known of what crosses.
double share_within(const AxisNoise& noise, const Neighbours& near, const Positions& p, const Array<Vec3>& normal,
                    const std::vector<Index>& inner) {
    const double own = noise.across * noise.across, more = std::max(0.0, noise.deviation * noise.deviation - own);
    Positions detail = p;
    for (int order = 0; order < 3; ++order) detail = detail_of(near, detail);
    double product = 0, square = 0;
    for (const Index v : inner) {
        const Vec3& n = normal[v];
        const double along = n.dot(detail[v]), facing = n.dot(noise.axis);
        const Vec3 expected = along * more * facing * (noise.axis - facing * n);  // times the variance
        product += (own + more * facing * facing) * expected.dot(detail[v]);
        square += expected.squaredNorm();
    }
    return square > 0 ? product / square : 0;
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
                                    const std::vector<Index>& inner, const Energies& energy, const Energies& bends) {
    const double mean = energy.mean();
    if (!(mean > 0)) return std::nullopt;
    const std::vector<Row> row = rows(near, normal, inner, bends);
    const double chance = by_chance / std::sqrt(static_cast<double>(inner.size()));
    const bool few = chance > explains;  // the energies do not tell enough: the places must, too
    const double least_explained = explains + (few ? 0 : chance);
    const Fit same = fitted(row, energy.field, mean, true), own = fitted(row, energy.field, mean, false);
    if (!own.found.allFinite() || !(own.deviation < (1 - least_explained) * same.deviation)) return std::nullopt;
    const Row& c = own.found;
    Eigen::Matrix3d covariance;
    covariance << c[0], c[3], c[4], c[3], c[1], c[5], c[4], c[5], c[2];
    const auto [values, vectors] = principal_axes(covariance);
    if (!(values[2] > stands_out * stands_out * std::max(0.0, values[1]))) return std::nullopt;
    const Vec3 axis = vectors.col(2);
    const auto facing = chunked_fold<Mean>(inner.size(), [&](Mean& part, std::size_t i) {
        part.add(std::pow(axis.dot(normal[static_cast<std::size_t>(inner[i])]), 2));
    });
    if (facing.value() < faced) return std::nullopt;  // nothing is known of noise that runs along the surface
    // Where it bends, noise shows as bends, too.
    const double rest = std::max(0.1, 1 - std::max(0.0, c[columns - 1]));
    const AxisNoise found{axis, std::sqrt(values[2] / rest), std::sqrt(std::max(0.0, values[1]) / rest)};
    if (few && share_within(found, near, p, normal, inner) < least_within) return std::nullopt;
    return found;
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
