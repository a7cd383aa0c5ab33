#include "denoise/patch.h"

#include "denoise/noise.h"
#include "measure/measure.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <utility>

namespace multires {
namespace {

constexpr double least_noise = 0.3;  ///< of the RMS: where noise is less it is taken for as much

/// Powers of x and y in the order of their degree.
constexpr std::array<std::array<int, 2>, 15> power = {{{0, 0},
                                                       {1, 0},
                                                       {0, 1},
                                                       {2, 0},
                                                       {1, 1},
                                                       {0, 2},
                                                       {3, 0},
                                                       {2, 1},
                                                       {1, 2},
                                                       {0, 3},
                                                       {4, 0},
                                                       {3, 1},
                                                       {2, 2},
                                                       {1, 3},
                                                       {0, 4}}};
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 15, 15>;
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 15, 1>;

/// Powers of a number up to the eighth.
std::array<double, 9> powers_of(double x) {
    std::array<double, 9> p{1};
    for (std::size_t k = 1; k < p.size(); ++k) p[k] = p[k - 1] * x;
    return p;
}

/// Sums of all products of powers of x and y up to a degree: what any least squares of polynomials is made of.
struct Moments {
    std::array<std::array<double, 9>, 9> sum{};

    void add(const std::array<double, 9>& x, const std::array<double, 9>& y, double weight, int degree) {
        for (int i = 0; i <= degree; ++i)
            for (int j = 0; j <= degree - i; ++j) sum[i][j] += weight * x[i] * y[j];
    }
    /// 0 if the factor is, whose powers may then be negative.
    double times(int factor, int i, int j) const { return factor == 0 ? 0 : factor * sum[i][j]; }
};

}  // namespace

double Patch::height(const Vec3& p) const {
    const double u = x.dot(p - center), v = y.dot(p - center);
    return z.dot(p - center) - bend[0] * u * u - bend[1] * u * v - bend[2] * v * v;
}

Vec3 Patch::gradient(const Vec3& p) const {
    const double u = x.dot(p - center), v = y.dot(p - center);
    return z - (2 * bend[0] * u + bend[1] * v) * x - (bend[1] * u + 2 * bend[2] * v) * y;
}

PlaceErrors PlaceErrors::of_rounding(double step) {
    PlaceErrors errors;
    errors.step_ = step;
    errors.rounding_ = step / std::sqrt(12.0);
    return errors;
}

PlaceErrors PlaceErrors::of_noise(std::vector<double> deviation) {
    PlaceErrors errors;
    const double least = least_noise * rms(deviation);
    for (double& d : deviation) d = std::max(d, least);
    errors.deviation_ = std::move(deviation);
    return errors;
}

double PlaceErrors::spread() const { return rounded() ? std::sqrt(0.8) : std::sqrt(2.0); }

double PlaceErrors::farthest(Index v) const { return farthest_by_noise * deviation_[v]; }

bool PlaceErrors::allows(double height, const Vec3& gradient, Index v) const {
    if (rounded()) return std::abs(height) <= 1.0001 * step_ / 2 * gradient.cwiseAbs().sum();
    return std::abs(height) <= farthest(v) * gradient.norm();
}

PatchFit fit_over(const Patch& patch, const std::vector<Index>& vertices, const Positions& places,
                  const PlaceErrors& errors, int degree) {
    const int count = terms_up_to(degree);
    const double n = static_cast<double>(vertices.size());
    PatchFit fit;
    double spread = 0;
    for (const Index v : vertices) spread += (places[v] - patch.center).squaredNorm() / n;
    fit.scale = std::sqrt(spread);
    Moments weighted, plain;
    Column b = Column::Zero(count);
    for (const Index v : vertices) {
        const Vec3 d = places[v] - patch.center;
        const auto x = powers_of(patch.x.dot(d) / fit.scale), y = powers_of(patch.y.dot(d) / fit.scale);
        const double h = patch.height(places[v]), weight = errors.weight(v);
        weighted.add(x, y, weight, 2 * degree);
        plain.add(x, y, 1 / (n * spread), 2 * degree - 2);
        for (int i = 0; i < count; ++i) b[i] += weight * h * x[power[i][0]] * y[power[i][1]];
    }
    Matrix a(count, count), g(count, count);  // products of the terms, and of their gradients
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j) {
            const int x = power[i][0] + power[j][0], y = power[i][1] + power[j][1];
            a(i, j) = weighted.sum[x][y];
            g(i, j) =
                plain.times(power[i][0] * power[j][0], x - 2, y) + plain.times(power[i][1] * power[j][1], x, y - 2);
        }
    const Eigen::LDLT<Matrix> solver(a);
    fit.coefficient = solver.solve(b);
    fit.tilt = std::sqrt(std::max(0.0, fit.coefficient.dot(g * fit.coefficient)));
    fit.tilt_by_noise = std::sqrt(std::max(0.0, Matrix(solver.solve(g)).trace()));
    return fit;
}

}  // namespace multires
