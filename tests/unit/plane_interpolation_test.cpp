#include "operator_fixtures.h"

namespace multires {

using namespace fixtures;

namespace {

constexpr double whole_turn = 6.283185307179586;

/// A regular ring of n around the origin, turned, and the vertex above a point of the plane.
ClosedStar regular_star(Index n, const Vec3& vertex) {
    Positions p{vertex};
    for (Index j = 0; j < n; ++j)
        p.emplace_back(std::cos(whole_turn * (j + 0.3) / n), std::sin(whole_turn * (j + 0.3) / n), 0);
    return ClosedStar(std::move(p));
}

double squared(double x, double y) { return x * x + y * y; }

/// Sibson's weights by counting points: the shares of the part of the square [-2, 2]^2 nearest to `foot` that other
/// sites would have without it.
std::vector<double> counted_shares(const Positions& sites, const Vec3& foot) {
    std::vector<double> share(sites.size(), 0);
    double all = 0;
    constexpr int steps = 1500;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double x = 4 * (i + 0.5) / steps - 2, y = 4 * (j + 0.5) / steps - 2;
            std::size_t nearest = 0;
            double least = 1e30;
            for (std::size_t k = 0; k < sites.size(); ++k)
                if (const double d = squared(sites[k].x() - x, sites[k].y() - y); d < least) least = d, nearest = k;
            if (squared(foot.x() - x, foot.y() - y) < least) ++share[nearest], ++all;
        }
    for (double& s : share) s /= all;
    return share;
}

}  // namespace

TEST(PlaneInterpolation, WeightsOfRegularRingsAreEqual) {
    for (const Index n : {3, 4, 5, 6, 7, 12, 64, 65, 300})
        for (const Operator op : {Operator::natural_neighbours, Operator::thin_plate})
            for (const double w : regular_star(n, {0, 0, 0.3}).weights(op))
                EXPECT_NEAR(w, 1.0 / n, n > 64 ? 1e-10 : 1e-12) << static_cast<int>(op) << ", " << n;
}

TEST(PlaneInterpolation, NaturalNeighboursShareTheCell) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        Positions p = planar_star(7, seed);
        for (std::size_t k = 1; k < p.size(); ++k) p[k] *= (0.6 + 0.2 * p[k].norm()) / p[k].norm();
        const std::vector<double> expected = counted_shares(Positions(p.begin() + 1, p.end()), p[0]);
        p[0].z() = 0.4;  // its height does not matter
        const Array<double> w = ClosedStar(p).weights(Operator::natural_neighbours);
        for (std::size_t k = 0; k < w.size(); ++k) EXPECT_NEAR(w[k], expected[k], 2e-3) << seed;
    }
}

TEST(PlaneInterpolation, PredictsAboveTheFoot) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        shapes::Random random(seed);
        Positions p = planar_star(6, seed);
        for (Vec3& q : p) q.z() = random.uniform(-0.3, 0.3);
        // The ring's plane, by its normal: the detail of a height above it is the height.
        for (const Operator op : {Operator::natural_neighbours, Operator::thin_plate}) {
            double norm = 1;
            const auto predicted = [&](double height, const Vec3& normal) {
                Positions moved = p;
                moved[0] += height * normal;
                const Array<double> w = ClosedStar(moved).weights(op);
                Vec3 sum = Vec3::Zero();
                for (std::size_t k = 0; k < w.size(); ++k) sum += w[k] * p[k + 1], norm += std::abs(w[k]);
                return sum;
            };
            const Vec3 normal = (p[0] - predicted(0, Vec3::Zero())).normalized();
            const Vec3 moved = predicted(0.2, normal);
            EXPECT_LE((moved - predicted(0, normal)).norm(), 1e-12 * norm) << seed << ": same foot, same weights";
        }
    }
}

TEST(PlaneInterpolation, AtTheFootOfANeighbourItIsTheNeighbours) {
    Positions p = planar_star(6, 3);
    p[0] = p[4];
    for (const Operator op : {Operator::natural_neighbours, Operator::thin_plate}) {
        const Array<double> w = ClosedStar(p).weights(op);
        for (Index k = 0; k < 6; ++k) EXPECT_NEAR(w[k], k == 3 ? 1 : 0, 1e-12);
    }
}

// Outside the hull the cell has no end: the plane fitted to the values, which is exact for linear ones.
TEST(PlaneInterpolation, OutsideTheHullLinearFunctionsAreReproduced) {
    for (const Vec3& vertex : {Vec3(1.2, 0.1, 0), Vec3(0.951, 0.309, 0.1), Vec3(-1.2, 1.6, 2), Vec3(1, 1, 0)}) {
        const ClosedStar star = regular_star(5, vertex);
        for (const Operator op : {Operator::natural_neighbours, Operator::thin_plate}) {
            const Array<double> w = star.weights(op);
            Vec3 sum = Vec3::Zero();
            for (std::size_t k = 0; k < w.size(); ++k) sum += w[k] * star.positions[k + 1];
            EXPECT_LE((sum - Vec3(vertex.x(), vertex.y(), 0)).norm(), 1e-13);
        }
    }
}

TEST(PlaneInterpolation, ThinPlatesInterpolateSmoothFunctionsBetterWithFlaps) {
    const Mesh mesh = shapes::plane(40);
    const Rings rings = rings_with_flaps(mesh);
    const auto value = [](const Vec3& p) { return std::sin(9 * p.x() + 4 * p.y()); };
    double error[3] = {};
    int which = 0;
    for (const Operator op : {Operator::natural_neighbours, Operator::thin_plate, Operator::thin_plate_flaps}) {
        const Rows rows = sparse_rows(rings, mesh.positions, with(op));
        for (Index r = 0; r < rings.rows(); ++r) {
            if (rings.kind[r] != RingKind::closed) continue;
            double sum = -value(mesh.positions[r]);
            for (Index k = rows.offset[r]; k < rows.offset[r + 1]; ++k)
                sum += rows.weight[k] * value(mesh.positions[rows.column[k]]);
            error[which] += sum * sum;
        }
        ++which;
    }
    EXPECT_LT(error[2], 0.25 * error[1]);
    EXPECT_LT(error[2], 0.25 * error[0]);
}

TEST(PlaneInterpolation, RingsWithoutAPlaneGetWeightsOfDelaunay) {
    // As wide along its axis as across it: any plane is as good.
    const double h = std::sqrt(0.5);
    const ClosedStar saddle({{0.1, 0.2, 0.1}, {1, 0, h}, {0, 1, -h}, {-1, 0, h}, {0, -1, -h}});
    for (const Operator op : {Operator::natural_neighbours, Operator::thin_plate})
        EXPECT_EQ(saddle.weights(op), saddle.weights(Operator::cotangent_delaunay));
    // Two neighbours one above the other.
    const ClosedStar overhang({{0, 0, 0}, {1, 0, 0}, {0.3, 1, 0.2}, {0.3, 1, -0.2}, {-1, 0, 0}, {0, -1, 0}});
    EXPECT_EQ(overhang.weights(Operator::thin_plate), overhang.weights(Operator::cotangent_delaunay));
}

}  // namespace multires
