#include "filters/analysis/scales.h"

#include "base/angles.h"
#include "filter_fixtures.h"
#include "filters/analysis/scale_space.h"
#include "fixtures.h"
#include "measure/measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace multires {

using namespace fixtures;

namespace {

double edge(const Mesh& mesh) { return mean_edge_length(mesh.faces, mesh.positions); }

Result scales(const Layer& layer, const ScaleOptions& options) {
    Session session;
    return scale_details(layer, options, session);
}

ScaleOptions within(int bands, double finest, double coarsest, ScaleValues values = ScaleValues::bands) {
    ScaleOptions o;
    o.bands = bands, o.finest = finest, o.coarsest = coarsest, o.values = values;
    return o;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < a.size(); ++i) ma += a[i], mb += b[i];
    ma /= static_cast<double>(a.size()), mb /= static_cast<double>(b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        aa += (a[i] - ma) * (a[i] - ma), bb += (b[i] - mb) * (b[i] - mb), ab += (a[i] - ma) * (b[i] - mb);
    }
    return ab / std::sqrt(aa * bb);
}

/// The share of a ball that is inside a surface, by points spread evenly over the ball: a volume integral invariant.
double share_inside(const Vec3& centre, double radius, const std::function<bool(const Vec3&)>& inside) {
    constexpr int cells = 20;
    int all = 0, in = 0;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j)
            for (int k = 0; k < cells; ++k) {
                const Vec3 p = (Vec3(i + 0.5, j + 0.5, k + 0.5) * 2 / cells - Vec3::Ones());
                if (p.squaredNorm() > 1) continue;
                ++all;
                in += inside(centre + radius * p);
            }
    return static_cast<double>(in) / all;
}

/// Correlation of heights over low passes, turned over, with the invariant, at four radii: the low pass at 2.22 radii
/// (to second order in the wave number both then take the same from waves).
void expect_like_invariants(const Mesh& mesh, const std::vector<Index>& where, double radius,
                            const std::function<bool(const Vec3&)>& inside) {
    constexpr double cutoff = 2.22;
    const Result r = scales(layer_of(mesh), within(4, cutoff * radius, 8 * cutoff * radius, ScaleValues::heights));
    ASSERT_EQ(r.attributes.size(), 4u);
    for (int s = 0; s < 4; ++s) {
        std::vector<double> height, volume;
        for (const Index v : where) {
            height.push_back(-r.attributes[s].values[v]);
            volume.push_back(share_inside(mesh.positions[v], radius * (1 << s), inside));
        }
        EXPECT_GT(correlation(height, volume), 0.9) << "radius " << radius * (1 << s);
    }
}

}  // namespace

TEST(Scales, TheChainHalvesWavesAsLongAsItsCutoffs) {
    std::vector<double> cutoffs;
    for (int b = 0; b < 16; ++b) cutoffs.push_back(3 * std::pow(1.3, b));
    const Chain chain(cutoffs);
    for (std::size_t b = 0; b < cutoffs.size(); ++b) {
        EXPECT_NEAR(chain.transmission(b, cutoffs[b]), 0.5, 1e-12);
        if (b == 0) continue;
        EXPECT_LT(chain.transmission(b, cutoffs[b - 1]), chain.transmission(b - 1, cutoffs[b - 1]));
    }
}

TEST(Scales, LowPassesLeaveWhatTheChainSays) {
    const auto sphere = shapes::banded_sphere({10000, 4, 30, 0.01, 0.003, {0.3, 0, 1}});
    const Spline spline(sphere.mesh, {}, {});
    const double wave = 2 * pi / std::sqrt(30.0 * 31);
    const std::vector<double> cutoffs{0.7 * wave, wave, 1.4 * wave};
    const Chain chain(cutoffs);
    for_each_low_pass(spline, sphere.mesh, cutoffs, 1e-3, {}, [&](std::size_t b, const Positions& low) {
        EXPECT_NEAR(BandsLeft(sphere, low).high, chain.transmission(b, wave), 0.02);
    });
}

TEST(Scales, BandsAddUpToTheHeightOverTheLast) {
    const auto sphere = shapes::banded_sphere({10000, 4, 30, 0.0, 0.003});
    const double e = edge(sphere.mesh);
    const Result bands = scales(layer_of(sphere.mesh), within(5, 3 * e, 24 * e));
    const Result heights = scales(layer_of(sphere.mesh), within(5, 3 * e, 24 * e, ScaleValues::heights));
    ASSERT_EQ(bands.attributes.size(), 5u);
    EXPECT_EQ(bands.attributes[0].values, heights.attributes[0].values);
    const std::vector<double> height = heights.attributes[4].values;
    std::vector<double> error(height.size());
    for (std::size_t i = 0; i < error.size(); ++i) {
        error[i] = -height[i];
        for (const Attribute& a : bands.attributes) error[i] += a.values[i];
    }
    EXPECT_LT(rms(error), 0.02 * rms(height));  // normals differ a little from band to band
}

TEST(Scales, SolvesAreAsGoodAsTheyNeedToBe) {
    const Mesh mesh = shapes::scan(20000);
    const Spline spline(mesh, {}, {});
    std::vector<double> cutoffs;
    for (int b = 0; b < 12; ++b) cutoffs.push_back(edge(mesh) * 3 * std::pow(1.35, b));
    std::vector<Positions> loose, exact;
    for_each_low_pass(spline, mesh, cutoffs, 1e-2, {}, [&](std::size_t, const Positions& p) { loose.push_back(p); });
    for_each_low_pass(spline, mesh, cutoffs, 1e-9, {}, [&](std::size_t, const Positions& p) { exact.push_back(p); });
    for (std::size_t b = 1; b < cutoffs.size(); ++b) {
        double error = 0, band = 0;
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const Vec3 d = exact[b - 1][i] - exact[b][i];
            band += d.squaredNorm(), error += (loose[b - 1][i] - loose[b][i] - d).squaredNorm();
        }
        EXPECT_LT(std::sqrt(error / band), 0.01) << b;
    }
}

TEST(Scales, TheQualityIsTheWavelengthOfWhatIsThere) {
    // Short waves on one half, long ones on the other.
    Mesh mesh = shapes::plane(150);
    for (Vec3& p : mesh.positions)
        p.z() = p.x() < 0.5 ? 0.001 * std::cos(2 * pi * 25 * p.y()) : 0.004 * std::cos(2 * pi * 5 * p.y());
    const Result r = scales(layer_of(mesh), within(6, 0.028, 0.8));
    const std::vector<double> middle = series(r.report, "wavelengths");
    int right = 0, all = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3& p = mesh.positions[i];
        if (p.y() < 0.2 || p.y() > 0.8 || std::abs(p.x() - 0.5) < 0.2 || std::abs(p.x() - 0.5) > 0.4) continue;
        ++all;
        right += p.x() < 0.5 ? (*r.quality)[i] < 0.08 : (*r.quality)[i] > 0.08;
    }
    EXPECT_GT(right, 0.9 * all);
    EXPECT_EQ(middle.size(), 6u);
}

TEST(Scales, GoWithVolumeIntegralInvariantsOfAHeightField) {
    std::vector<std::array<double, 4>> waves;
    shapes::Random random(3);
    for (int i = 0; i < 20; ++i) {
        const double wave = 0.03 * std::pow(2, 4 * random.uniform()), angle = random.uniform(0, 2 * pi);
        waves.push_back(
            {2 * pi / wave * std::cos(angle), 2 * pi / wave * std::sin(angle), random.uniform(0, 6), 0.02 * wave});
    }
    const auto z = [&](double x, double y) {
        double sum = 0;
        for (const auto& w : waves) sum += w[3] * std::cos(w[0] * x + w[1] * y + w[2]);
        return sum;
    };
    Mesh mesh = shapes::plane(200);
    for (Vec3& p : mesh.positions) p.z() = z(p.x(), p.y());
    std::vector<Index> where;
    while (where.size() < 60) {
        const Index v = static_cast<Index>(random.bits() % mesh.positions.size());
        const Vec3& p = mesh.positions[v];
        if (std::min({p.x(), p.y(), 1 - p.x(), 1 - p.y()}) > 0.2) where.push_back(v);
    }
    expect_like_invariants(mesh, where, 0.02, [&](const Vec3& p) { return p.z() < z(p.x(), p.y()); });
}

TEST(Scales, GoWithVolumeIntegralInvariantsOfAClosedShape) {
    // A torus with bumps of three sizes: inside is where the distance to its core is less than the tube there.
    const auto tube = [](double u, double v) {
        return 0.4 + 0.02 * std::cos(3 * u + 2 * v) + 0.008 * std::cos(11 * u - 5 * v) +
               0.003 * std::cos(29 * u + 13 * v);
    };
    Mesh mesh = shapes::torus(360, 150);
    for (Vec3& p : mesh.positions) {
        const double u = std::atan2(p.y(), p.x());
        const Vec3 core(std::cos(u), std::sin(u), 0), d = p - core;
        const double v = std::atan2(d.z(), d.dot(core));
        p = core + tube(u, v) * (std::cos(v) * core + std::sin(v) * Vec3(0, 0, 1));
    }
    const auto inside = [&](const Vec3& p) {
        const double u = std::atan2(p.y(), p.x()), r = std::hypot(p.x(), p.y()) - 1;
        return std::hypot(r, p.z()) < tube(u, std::atan2(p.z(), r));
    };
    std::vector<Index> where;
    shapes::Random random(6);
    for (int i = 0; i < 100; ++i) where.push_back(static_cast<Index>(random.bits() % mesh.positions.size()));
    expect_like_invariants(mesh, where, 0.03, inside);
}

TEST(Scales, RefusesWhatMakesNoBands) {
    const Layer layer = layer_of(shapes::irregular_sphere(1000));
    const double e = edge(layer.mesh);
    const auto says = [&](ScaleOptions o, const char* what) {
        try {
            scales(layer, o);
            ADD_FAILURE() << what;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
        }
    };
    says(within(0, 3 * e, 9 * e), "bands");
    says(within(17, 3 * e, 9 * e), "bands");
    says(within(3, e, 9 * e), "finest must be at least two mean edges");
    says(within(3, std::nan(""), 9 * e), "finest");
    says(within(3, 9 * e, 9 * e), "coarsest must be more than finest");
    says(within(1, 0, e), "coarsest must be at least two mean edges");
    says(within(3, 3 * e, HUGE_VAL), "coarsest must be a number");
    ScaleOptions o = within(3, 3 * e, 9 * e);
    o.name = "a b";
    says(o, "prefix");
    o.name = "";
    says(o, "prefix");
    EXPECT_EQ(scales(layer, within(1, 0, 9 * e)).attributes.size(), 1u);
}

}  // namespace multires
