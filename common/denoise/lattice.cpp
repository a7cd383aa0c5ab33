#include "denoise/lattice.h"

#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace multires {
namespace {

constexpr double coordinate_rounding = 1e-6;  ///< of the largest coordinate: single precision, with a margin
constexpr double off = 0.05;                  ///< how far a coordinate may be from the lattice, in steps

/// The different values of a coordinate, ascending.
std::vector<double> levels(const Positions& p, int axis, double tolerance) {
    std::vector<double> values(p.size());
    for (std::size_t i = 0; i < p.size(); ++i) values[i] = p[i][axis];
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end(), [&](double a, double b) { return b - a < tolerance; }),
                 values.end());
    return values;
}

/// Least-squares step if `step` is near it and all values lie on its lattice.
std::optional<double> fitted(const std::vector<double>& values, double step) {
    double product = 0, square = 0;
    for (const double x : values) {
        const double n = std::round((x - values[0]) / step);
        if (std::abs(x - values[0] - n * step) > off * step) return std::nullopt;
        product += n * (x - values[0]);
        square += n * n;
    }
    return square > 0 ? product / square : step;
}

}  // namespace

std::optional<double> lattice_step(const Positions& p, double least) {
    double largest = 0;
    for (const Vec3& v : p) largest = std::max(largest, v.cwiseAbs().maxCoeff());
    const double tolerance = coordinate_rounding * largest;
    if (!(least > 10 * tolerance)) return std::nullopt;
    std::array<std::vector<double>, 3> values;
    double step = 2 * largest;
    for (int axis = 0; axis < 3; ++axis) {
        values[axis] = levels(p, axis, tolerance);
        for (std::size_t i = 1; i < values[axis].size(); ++i)
            step = std::min(step, values[axis][i] - values[axis][i - 1]);
        if (step < least) return std::nullopt;
    }
    for (int round = 0; round < 2; ++round)
        for (const auto& v : values) {
            const std::optional<double> better = fitted(v, step);
            if (!better) return std::nullopt;
            if (v.size() > 2) step = *better;
        }
    return step;
}

bool between_voxels(const Positions& positions, double step) {
    if (positions.empty()) return false;
    // Which multiples are even cannot be seen at one vertex: every way to count them is tried.
    std::array<bool, 8> may_be;
    may_be.fill(true);
    for (const Vec3& p : positions) {
        std::array<unsigned, 3> odd;
        for (int c = 0; c < 3; ++c)
            odd[c] = std::fmod(std::abs(std::round((p[c] - positions[0][c]) / step)), 2) != 0 ? 1 : 0;
        for (unsigned way = 0; way < may_be.size(); ++way) {
            unsigned count = 0;
            for (unsigned c = 0; c < 3; ++c) count += odd[c] ^ (way >> c & 1U);
            may_be[way] = may_be[way] && count == 1;
        }
    }
    return std::find(may_be.begin(), may_be.end(), true) != may_be.end();
}

void keep_within_cells(const Positions& rounded, double farthest, Positions& positions) {
    parallel_for(static_cast<Index>(positions.size()), [&](Index v) {
        const Vec3 most = Vec3::Constant(farthest);
        positions[v] = positions[v].cwiseMax(rounded[v] - most).cwiseMin(rounded[v] + most);
    });
}

}  // namespace multires
