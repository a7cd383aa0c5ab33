#include "filters/grid/grid_signal.h"
#include "grids/extension.h"
#include "grids/grid_pyramid.h"

#include "filter_fixtures.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <vector>

// The wavelets of triangular grids: exact reconstruction, no preferred direction, and the functions that the formula of
// box splines gives.

namespace multires {
namespace {

constexpr std::array<SplineBasis, 2> both{SplineBasis::linear, SplineBasis::quartic};

using Place = std::array<Index, 2>;
using Samples = std::map<Place, double>;

/// A ragged domain with holes and random values.
Samples ragged(Index size, std::uint64_t seed) {
    shapes::Random random(seed);
    Samples samples;
    for (Index i = 0; i < size; ++i)
        for (Index j = 0; j < size + 7; ++j) {
            const bool hole = std::hypot(i - 0.5 * size, j - 0.3 * size) < 0.15 * size;
            if (!hole && i + j > 5 && !random.chance(0.05)) samples[{i, j}] = random.uniform(-1, 1);
        }
    return samples;
}

/// Samples as a grid whose point (0, 0) is the domain's corner, moved down to a multiple of `step`.
struct Placed {
    Grid grid;
    Raster raster;
    Place base{};

    Placed(const Samples& samples, Index step) {
        Place low = samples.begin()->first, high = low;
        for (const auto& [p, value] : samples)
            for (int k = 0; k < 2; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
        for (int k = 0; k < 2; ++k) base[k] = static_cast<Index>(std::floor(low[k] / double(step))) * step;
        grid.rows = high[0] - base[0] + 1, grid.columns = high[1] - base[1] + 1;
        raster = Raster(grid.rows, grid.columns, 0);
        grid.vertex.assign(raster.values.size(), -1);
        for (const auto& [p, value] : samples) {
            const std::size_t at = static_cast<std::size_t>(p[0] - base[0]) * grid.columns + (p[1] - base[1]);
            grid.vertex[at] = grid.vertices++;
            raster.values[at] = value;
        }
    }
};

double largest_error(const GridPyramid& pyramid, const Raster& a, const Raster& b) {
    double largest = 0;
    for (std::size_t p = 0; p < a.values.size(); ++p)
        if (pyramid.mask(0).values[p]) largest = std::max(largest, std::abs(a.values[p] - b.values[p]));
    return largest;
}

/// All coefficients by level, type and place on the lattice.
using ByPlace = std::map<std::array<Index, 4>, double>;

ByPlace coefficients_of(const Samples& samples, SplineBasis basis, int levels) {
    const Placed placed(samples, 1 << levels);
    const GridPyramid pyramid(placed.grid, basis, levels);
    const Array<double> x = pyramid.analyse(placed.raster);
    ByPlace all;
    Place base = placed.base;
    for (int k = 0; k < pyramid.levels(); ++k) {
        const CoarseBox box = pyramid.box(k);
        for (Index& b : base) b = b / 2 + box.first;
        for (int type = k + 1 == levels ? 0 : 1; type < subbands; ++type)
            for (std::size_t p = 0; p < pyramid.band_size(k); ++p)
                if (pyramid.mask(k + 1).values[p])
                    all[{k, type, base[0] + static_cast<Index>(p) / box.columns,
                         base[1] + static_cast<Index>(p) % box.columns}] = x[pyramid.offset(k, type) + p];
    }
    return all;
}

/// The lattice turned by 60 degrees: e1, e2, e3 become -e3, -e1, -e2.
Place turned(Place p) { return {p[0] - p[1], p[0]}; }
Place mirrored(Place p) { return {p[1], p[0]}; }

int turned_type(int type) {
    const int s1 = type >> 2 & 1, s2 = type >> 1 & 1, s3 = type & 1;
    return 4 * s2 + 2 * s3 + s1;
}

double expected_turned(const ByPlace& of, SplineBasis basis, std::array<Index, 4> at, ByPlace& out) {
    const int type = turned_type(at[1]);
    const int high = (type >> 2 & 1) + (type >> 1 & 1) + (type & 1);
    Place to = turned({at[2], at[3]});
    const double sign = basis == SplineBasis::linear && high % 2 ? -1 : 1;
    if (basis == SplineBasis::quartic) {  // whose wavelets lie one point ahead
        const int s1 = type >> 2 & 1, s2 = type >> 1 & 1, s3 = type & 1;
        to = {to[0] - s1 + s3, to[1] - s2 + s3};
    }
    return out[{at[0], type, to[0], to[1]}] = sign * of.at(at);
}

void expect_same(const ByPlace& a, const ByPlace& b) {
    int compared = 0;
    for (const auto& [at, value] : a) {
        const auto other = b.find(at);
        if (other == b.end()) continue;  // at the rim, the pyramid keeps a few more of one type than of another
        EXPECT_NEAR(value, other->second, 1e-12) << "level " << at[0] << ", type " << at[1];
        ++compared;
    }
    EXPECT_GT(compared, 0.9 * static_cast<double>(a.size()));
}

/// The value at x of the box spline of some directions, by de Boor's recurrence.
double box_spline(Eigen::Vector2d x, const std::vector<Eigen::Vector2d>& directions) {
    if (directions.size() == 2) {
        Eigen::Matrix2d m;
        m << directions[0], directions[1];
        if (std::abs(m.determinant()) < 0.5) return 0;
        const Eigen::Vector2d t = m.inverse() * x;
        return t.minCoeff() >= 0 && t.maxCoeff() < 1 ? 1 / std::abs(m.determinant()) : 0;
    }
    Eigen::Matrix2Xd m(2, directions.size());
    for (std::size_t r = 0; r < directions.size(); ++r) m.col(static_cast<Eigen::Index>(r)) = directions[r];
    const Eigen::VectorXd t = m.transpose() * (m * m.transpose()).inverse() * x;
    double sum = 0;
    for (std::size_t r = 0; r < directions.size(); ++r) {
        std::vector<Eigen::Vector2d> rest = directions;
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(r));
        const double tr = t[static_cast<Eigen::Index>(r)];
        sum += tr * box_spline(x, rest) + (1 - tr) * box_spline(x - directions[r], rest);
    }
    return sum / (static_cast<double>(directions.size()) - 2);
}

double scaling_function(SplineBasis basis, double i, double j) {
    const std::vector<Eigen::Vector2d> once{{1, 0}, {0, 1}, {-1, -1}};
    std::vector<Eigen::Vector2d> all = once;
    if (basis == SplineBasis::quartic) all.insert(all.end(), once.begin(), once.end());
    return box_spline({i + 3e-12, j + 7e-12}, all);  // off the lines where the first pieces jump
}

/// Samples around the one function of a coefficient in the middle, `levels` finer: of the scaling functions there.
Raster function(SplineBasis basis, int levels) {
    Raster r(9, 9, 0);
    r.row(4)[4] = 1;
    for (int k = 0; k < levels; ++k) {
        const Index size = 2 * (r.rows - 1) + 1;
        const CoarseBox box = coarse_box(basis, size, size);
        r = subdivided(extended(r, Mask(r.rows, r.columns, 1), -box.first), basis, size, size);
    }
    return r;
}

}  // namespace

TEST(BoxSpline, SamplesComeBackFromTheirCoefficients) {
    for (const SplineBasis basis : both)
        for (const Index size : {1, 2, 3, 12, 50}) {
            Samples samples = ragged(size, 5);
            if (samples.empty()) samples[{0, 0}] = 1;
            const Placed placed(samples, 1);
            const GridPyramid pyramid(placed.grid, basis, 4);
            const Raster again = pyramid.synthesise(pyramid.analyse(placed.raster));
            EXPECT_LT(largest_error(pyramid, placed.raster, again), 1e-12) << size;
        }
}

TEST(BoxSpline, CoefficientsTurnAndMirrorWithTheSamples) {
    const Samples samples = ragged(30, 7);
    Samples turn, mirror;
    for (const auto& [p, value] : samples) turn[turned(p)] = value, mirror[mirrored(p)] = value;
    for (const SplineBasis basis : both) {
        const ByPlace here = coefficients_of(samples, basis, 2);
        ByPlace turned_here, mirrored_here;
        for (const auto& [at, value] : here) {
            expected_turned(here, basis, at, turned_here);
            const int type = (at[1] >> 2 & 1) * 2 + (at[1] >> 1 & 1) * 4 + (at[1] & 1);
            mirrored_here[{at[0], type, at[3], at[2]}] = value;
        }
        expect_same(turned_here, coefficients_of(turn, basis, 2));
        expect_same(mirrored_here, coefficients_of(mirror, basis, 2));
    }
}

TEST(BoxSpline, CorrelationIsTheTransposeOfSynthesis) {
    for (const SplineBasis basis : both) {
        const Placed placed(ragged(25, 2), 1);
        const GridPyramid pyramid(placed.grid, basis, 3);
        shapes::Random random(3);
        const Array<double> common = pyramid.correlate(placed.raster);
        Array<double> x(pyramid.size(), 0);
        for (std::size_t i = 0; i < x.size(); ++i)
            if (common[i] != 0) x[i] = random.uniform(-1, 1);
        const Raster made = pyramid.synthesise(x);
        double one = 0, other = 0;
        for (std::size_t i = 0; i < x.size(); ++i) one += x[i] * common[i];
        for (std::size_t p = 0; p < made.values.size(); ++p) other += made.values[p] * placed.raster.values[p];
        EXPECT_NEAR(one, other, 1e-10);
    }
}

TEST(BoxSpline, ScalingFunctionsAreThoseOfTheFormula) {
    for (const SplineBasis basis : both) {
        const Raster r = function(basis, 3);
        const Index middle = r.rows / 2;
        for (Index i = middle - 18; i <= middle + 18; ++i)
            for (Index j = middle - 18; j <= middle + 18; ++j) {
                double value = r.row(i)[j];  // a sum of linear functions is its coefficients
                if (basis == SplineBasis::quartic) {
                    value /= 2;
                    for (const auto& s : lattice_steps) value += r.row(i + s[0])[j + s[1]] / 12;
                }
                EXPECT_NEAR(value, scaling_function(basis, (i - middle) / 8.0, (j - middle) / 8.0), 1e-9);
            }
    }
}

/// Steps of the divided differences of an order from point to point, at the spacing of a level: they go to 0 with it
/// where the derivative is continuous.
double largest_step(SplineBasis basis, int order, int levels) {
    const Raster r = function(basis, levels);
    double largest = 0;
    for (const auto& s : lattice_steps)
        for (Index i = 4; i + 4 < r.rows; ++i)
            for (Index j = 4; j + 4 < r.columns; ++j) {
                const auto f = [&](Index k) { return r.row(i + k * s[0])[j + k * s[1]]; };
                const double step = order == 0 ? f(1) - f(0) : f(2) - 3 * f(1) + 3 * f(0) - f(-1);
                largest = std::max(largest, std::abs(step) * std::ldexp(1, order * levels));
            }
    return largest;
}

TEST(BoxSpline, LinearFunctionsAreContinuousAndQuarticOnesTwiceDifferentiable) {
    EXPECT_NEAR(largest_step(SplineBasis::linear, 0, 5), 0.5 * largest_step(SplineBasis::linear, 0, 4), 1e-12);
    EXPECT_GT(largest_step(SplineBasis::linear, 2, 5), 1.9 * largest_step(SplineBasis::linear, 2, 4));
    EXPECT_LT(largest_step(SplineBasis::quartic, 2, 5), 0.6 * largest_step(SplineBasis::quartic, 2, 4));
}

TEST(BoxSpline, NormsAreThoseOfTheFunctions) {
    Samples samples;
    for (Index i = 0; i < 80; ++i)
        for (Index j = 0; j < 80; ++j) samples[{i, j}] = 0;
    const Placed placed(samples, 1);
    for (const SplineBasis basis : both) {
        const GridPyramid pyramid(placed.grid, basis, 2);
        for (const auto& [level, type] : {std::array<int, 2>{0, 1}, {0, 6}, {1, 0}, {1, 3}, {1, 7}}) {
            Array<double> x(pyramid.size(), 0);
            const CoarseBox box = pyramid.box(level);
            x[pyramid.offset(level, type) + static_cast<std::size_t>(box.rows / 2) * box.columns + box.columns / 2] = 1;
            const Raster r = pyramid.synthesise(x);
            double sum = 0;
            for (const double v : r.values) sum += v * v;
            EXPECT_NEAR(pyramid.norm(level, type), std::sqrt(sum), 1e-12);
        }
    }
}

TEST(Extension, ContinuesAConstantAndFillsEverything) {
    const Placed placed(ragged(20, 4), 1);
    Raster ones(placed.grid.rows, placed.grid.columns, 0);
    Mask mask(ones.rows, ones.columns, 0);
    for (std::size_t p = 0; p < mask.values.size(); ++p)
        if (placed.grid.vertex[p] >= 0) mask.values[p] = 1, ones.values[p] = 3;
    const Raster out = extended(ones, mask, 9);
    EXPECT_EQ(out.rows, ones.rows + 18);
    for (const double x : out.values) EXPECT_NEAR(x, 3, 1e-14);
}

}  // namespace multires
