#include "operator_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace multires {

using namespace fixtures;

TEST(Cotangent, WeightsAreThoseOfTheAngles) {
    const Mesh mesh = shapes::scan(500);
    const Rings rings = rings_with_flaps(mesh);
    const auto weight = ring_weights(rings, mesh.positions, with(Operator::cotangent)).weight;
    const auto cot = [&](Index at, Index a, Index b) {
        const Vec3 u = mesh.positions[a] - mesh.positions[at], v = mesh.positions[b] - mesh.positions[at];
        return 1 / std::tan(std::acos(u.normalized().dot(v.normalized())));
    };
    for (Index r = 0; r < rings.rows(); ++r) {
        const Index n = rings.size(r), *ring = rings.begin(r);
        Eigen::VectorXd expected(n);
        for (Index j = 0; j < n; ++j) {
            expected[j] = cot(ring[(j + 1) % n], r, ring[j]) + cot(ring[(j + n - 1) % n], r, ring[j]);
        }
        expected /= expected.sum();
        for (Index j = 0; j < n; ++j) EXPECT_NEAR(weight[rings.offset[r] + j], expected[j], 1e-11);
    }
}

TEST(Cotangent, DegenerateTrianglesAreLeftOut) {
    // Neighbour 3 lies on the spoke to neighbour 2, so that triangle (0, 2, 3) has no area; without it the ring is the
    // chain 3, 4, 1, 2, whose cotangents are those of three triangles with legs of known lengths at a right angle.
    const ClosedStar star({{0, 0, 0}, {0, -1, 0}, {2, 0, 0}, {1, 0, 0}, {0, 3, 0}, {-1, 0, 0}});
    // Triangles (3, 4): legs 1, 3; (4, 5): legs 3, 1; (5, 1): legs 1, 1; (1, 2): legs 1, 2. The angle at the end of a
    // leg a has the cotangent a / other leg.
    std::vector<double> expected{1.0 + 2.0, 0.5, 3.0, 1.0 / 3 + 1.0 / 3, 3.0 + 1.0};
    double sum = 0;
    for (const double w : expected) sum += w;
    const Array<double> w = star.weights(Operator::cotangent);
    for (int k = 0; k < 5; ++k) EXPECT_NEAR(w[k], expected[k] / sum, 1e-15) << k;
}

TEST(Cotangent, ClampedIsBoundedOnSlivers) {
    const double height = 1e-7;
    const ClosedStar star({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, -height, 0}, {0, -1, 0}, {0.5, -height, 0}});
    const auto largest = [](const Array<double>& w) { return *std::max_element(w.begin(), w.end()); };
    const auto least = [](const Array<double>& w) { return *std::min_element(w.begin(), w.end()); };
    EXPECT_LT(least(star.weights(Operator::cotangent)), -0.1);
    EXPECT_EQ(least(star.weights(Operator::cotangent_clamped)), 0);
    EXPECT_LE(largest(star.weights(Operator::cotangent_clamped)), 1);
}

TEST(Cotangent, DelaunayEqualsPlainOnDelaunayMeshes) {
    const Mesh mesh = shapes::icosphere(8);
    const Rings rings = rings_with_flaps(mesh);
    EXPECT_EQ(ring_weights(rings, mesh.positions, with(Operator::cotangent_delaunay)).weight,
              ring_weights(rings, mesh.positions, with(Operator::cotangent)).weight);
}

TEST(Cotangent, DelaunayKeepsTheSpokesToTheConvexHullUnderInversion) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const ClosedStar star(planar_star(4 + seed % 20, seed));
        const Array<double> w = star.weights(Operator::cotangent_delaunay);
        const auto inverted = [&](std::size_t k) {
            return Vec3(star.positions[k + 1] / star.positions[k + 1].squaredNorm());
        };
        Vec3 mean = Vec3::Zero();
        for (std::size_t k = 0; k < w.size(); ++k) {
            mean += w[k] * star.positions[k + 1];
            // A point is a corner of the hull if all others lie on one side of some line through it: no gap of 180
            // degrees between the directions to them means it is inside.
            std::vector<double> angle;
            for (std::size_t l = 0; l < w.size(); ++l) {
                const Vec3 d = inverted(l) - inverted(k);
                if (l != k) angle.push_back(std::atan2(d.y(), d.x()));
            }
            std::sort(angle.begin(), angle.end());
            double gap = angle.front() + 2 * std::acos(-1.0) - angle.back();
            for (std::size_t l = 1; l < angle.size(); ++l) gap = std::max(gap, angle[l] - angle[l - 1]);
            EXPECT_EQ(w[k] > 0, gap > std::acos(-1.0)) << "seed " << seed << " neighbour " << k;
        }
        EXPECT_LT(mean.norm(), 1e-14) << "seed " << seed;
    }
}

TEST(Cotangent, DelaunayInterpolatesOnAnEdgeAndSeesThroughHiddenNeighbours) {
    // The vertex lies on the edge between neighbours 1 and 2, nearer to 1.
    const ClosedStar on_edge({{0, 0, 0}, {1, 0, 0}, {-3, 0, 0}, {0, -1, 0}});
    EXPECT_EQ(on_edge.weights(Operator::cotangent_delaunay), (Array<double>{0.75, 0.25, 0}));
    // Neighbour 2 lies behind neighbour 3, or the other way round.
    for (const int behind : {1, 2}) {
        Positions p{{0, 0, 0}, {0, -1, 0}, {1, 0, 0}, {1, 0, 0}, {0, 3, 0}, {-1, 0, 0}};
        p[1 + behind].x() = 2;
        const Array<double> w = ClosedStar(p).weights(Operator::cotangent_delaunay);
        EXPECT_EQ(w[behind], 0);
        Vec3 mean = Vec3::Zero();
        for (int k = 0; k < 5; ++k) mean += w[k] * p[k + 1];
        EXPECT_LT(mean.norm(), 1e-15);
    }
}

TEST(Cotangent, CoincidentNeighboursShareTheWeightOfOne) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        const ClosedStar star(planar_star(8, seed));
        for (std::size_t twin = 1; twin <= 8; ++twin) {
            Positions doubled(star.positions);
            doubled.insert(doubled.begin() + static_cast<std::ptrdiff_t>(twin), doubled[twin]);
            for (const Operator op : {Operator::cotangent, Operator::cotangent_delaunay}) {
                const Array<double> one = star.weights(op);
                Array<double> two = ClosedStar(doubled).weights(op);
                two[twin - 1] += two[twin];
                two.erase(two.begin() + static_cast<std::ptrdiff_t>(twin));
                for (std::size_t k = 0; k < 8; ++k) EXPECT_NEAR(two[k], one[k], 1e-12 * (1 + std::abs(one[k]))) << seed;
            }
        }
    }
}

TEST(Cotangent, NeighbourOnTheVertexIsLeftOut) {
    const ClosedStar star({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}});
    for (const Operator op : {Operator::cotangent, Operator::cotangent_clamped, Operator::cotangent_delaunay}) {
        EXPECT_EQ(star.weights(op), (Array<double>{0, 0.25, 0.5, 0.25}));
    }
}

TEST(Cotangent, NeighbourAtTheShortestDistanceThereIsGivesAllItsWeights) {
    // Found by the fuzzer. The square of the second spoke is 0, but its dot products are not.
    const double t = std::numeric_limits<double>::denorm_min();
    const ClosedStar star({{t, t, t},
                           {-6, -3.75, 2.25},
                           {0, t, t},
                           {-3.75, -4.25, -2.125},
                           {t, t, -13.25},
                           {3.75, 2.25, -6},
                           {6, 3.75, 2.25}});
    EXPECT_EQ(star.weights(Operator::cotangent_delaunay), (Array<double>{0, 1, 0, 0, 0, 0}));
}

TEST(Cotangent, DegenerateIsRelativeToTheEdges) {
    // The vertex lies at this height above the edge between neighbours 1 and 3, whose length is 2.
    for (const double scale : {1e-30, 1.0, 1e30}) {
        for (const double height : {1e-12, 1e-8}) {
            Positions p{{0, 0, 0}, {1, -height, 0}, {0, 1, 0}, {-1, -height, 0}};
            for (Vec3& q : p) q *= scale;
            const Array<double> w = ClosedStar(p).weights(Operator::cotangent);
            if (height < 1e-10) {  // left out: half a star, as above
                for (int k = 0; k < 3; ++k) EXPECT_NEAR(w[k], k == 1 ? 0.5 : 0.25, 1e-11);
            } else {  // in: interpolation along the edge
                for (int k = 0; k < 3; ++k) EXPECT_NEAR(w[k], k == 1 ? 0 : 0.5, 1e-7);
            }
        }
    }
}

}  // namespace multires
