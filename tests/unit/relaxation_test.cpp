#include "operator_fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace multires {

using namespace fixtures;

TEST(Relaxation, RowsSumToOneOrAreFixed) {
    for (const auto& [name, mesh] : every_class()) {
        const Rings rings = rings_with_flaps(mesh);
        for (const Operator op : all_operators) {
            const Rows rows = sparse_rows(rings, mesh.positions, with(op));
            ASSERT_EQ(rows.offset.size(), rings.kind.size() + 1);
            for (Index r = 0; r < rings.rows(); ++r) {
                const double expected = is_fixed(rows.fixed, r) ? 0 : 1;
                EXPECT_NEAR(sum_of_row(rows, r), expected, 1e-14 * largest_weight(rows, r) * (1 + rings.size(r)))
                    << name << " operator " << static_cast<int>(op) << " row " << r;
            }
        }
    }
}

TEST(Relaxation, WithoutFeaturesExactlyTheRowsWithoutRingAreFixed) {
    for (const auto& [name, mesh] : every_class()) {
        const Rings rings = rings_with_flaps(mesh);
        std::vector<Index> without;
        for (Index r = 0; r < rings.rows(); ++r) {
            if (rings.kind[r] == RingKind::irregular || rings.kind[r] == RingKind::isolated) without.push_back(r);
        }
        for (const Operator op : all_operators)
            EXPECT_EQ(ring_weights(rings, mesh.positions, with(op)).fixed, without) << name;
    }
}

TEST(Relaxation, LinearFunctionsOfPlanarMeshesAreReproduced) {
    for (const Mesh& mesh : {shapes::plane(30), shapes::disk(15), shapes::plane(10, {0, 0, 1}), shapes::fan(300)}) {
        const Rings rings = rings_with_flaps(mesh);
        for (const Operator op : linear_precise) {
            const Rows rows = sparse_rows(rings, mesh.positions, with(op));
            const Positions result = relaxed(rings, ring_weights(rings, mesh.positions, with(op)), mesh.positions);
            Index interior = 0;
            for (Index r = 0; r < rings.rows(); ++r) {
                if (rings.kind[r] != RingKind::closed) continue;
                ++interior;
                EXPECT_LT((result[r] - mesh.positions[r]).norm(), 1e-13 * largest_weight(rows, r))
                    << "operator " << static_cast<int>(op) << " row " << r;
            }
            EXPECT_GT(interior, 0);
        }
    }
}

TEST(Relaxation, StableStepsNeverGrow) {
    double plain = 0;
    for (const auto& [name, mesh] : every_class()) {
        const Rings rings = rings_with_flaps(mesh);
        for (const Operator op : all_operators) {
            const RingWeights weights = ring_weights(rings, mesh.positions, with(op));
            const Array<double> share = stable_steps(rings, weights);
            Positions f(mesh.positions.size()), whole;
            for (std::size_t v = 0; v < f.size(); ++v)
                for (int c = 0; c < 3; ++c) f[v][c] = std::sin(static_cast<double>((3 * v + c) * (3 * v + c)));
            whole = f;
            for (int step = 0; step < 200; ++step) {
                const Positions next = relaxed(rings, weights, f);
                for (Index r = 0; r < rings.rows(); ++r) f[r] += share[r] * (next[r] - f[r]);
                if (step < 50) whole = relaxed(rings, weights, whole);
            }
            double largest = 0;
            for (std::size_t v = 0; v < f.size(); ++v) {
                largest = std::max(largest, f[v].cwiseAbs().maxCoeff());
                plain = std::max(plain, whole[v].cwiseAbs().maxCoeff());
            }
            if (op != Operator::thin_plate_flaps) {  // solves no symmetric system: grows, slowly, on machined parts
                EXPECT_LE(largest, 3) << name << " operator " << static_cast<int>(op);
            }
        }
    }
    EXPECT_GT(plain, 1e6) << "whole steps were meant to grow, or the test tests nothing";
}

TEST(Relaxation, UmbrellaMovesVerticesWithinThePlane) {
    const Mesh mesh = shapes::plane(30);
    const Rings rings = rings_with_flaps(mesh);
    const Positions result =
        relaxed(rings, ring_weights(rings, mesh.positions, with(Operator::umbrella)), mesh.positions);
    double largest = 0;
    for (Index r = 0; r < rings.rows(); ++r) {
        if (rings.kind[r] == RingKind::closed) largest = std::max(largest, (result[r] - mesh.positions[r]).norm());
    }
    EXPECT_GT(largest, 0.1 / 30);
}

TEST(Relaxation, WeightsNonnegativeWherePromised) {
    for (const auto& [name, mesh] : every_class()) {
        const Rings rings = rings_with_flaps(mesh);
        for (const Operator op : {Operator::umbrella, Operator::cotangent_clamped, Operator::cotangent_delaunay}) {
            for (const double w : ring_weights(rings, mesh.positions, with(op)).weight) {
                EXPECT_GE(w, 0) << name;
                EXPECT_LE(w, 1) << name;
            }
        }
    }
    const Mesh mesh = shapes::plane(30);  // the plain weights of this mesh are not all positive
    const auto plain = ring_weights(rings_with_flaps(mesh), mesh.positions, with(Operator::cotangent)).weight;
    EXPECT_LT(*std::min_element(plain.begin(), plain.end()), -0.01);
}

TEST(Relaxation, SameUnderRotationTranslationScalingAndReflection) {
    const Eigen::AngleAxisd turn(1.1, Vec3(1, 2, 3).normalized());
    for (const auto& [name, mesh] : every_class()) {
        if (name == "collinear_faces" || name == "coincident_vertices") continue;  // degenerate up to rounding
        const Rings rings = rings_with_flaps(mesh);
        Positions moved(mesh.positions);
        for (Vec3& p : moved) p = 1000 * (turn * Vec3(p.x(), p.y(), -p.z())) + Vec3(10, -20, 30);
        for (const Operator op : all_operators) {
            const Rows a = sparse_rows(rings, mesh.positions, with(op)), b = sparse_rows(rings, moved, with(op));
            ASSERT_EQ(a.column, b.column);
            EXPECT_EQ(a.fixed, b.fixed) << name;
            for (Index r = 0; r < rings.rows(); ++r) {
                for (Index k = a.offset[r]; k < a.offset[r + 1]; ++k) {
                    ASSERT_NEAR(a.weight[k], b.weight[k], 1e-10 * largest_weight(a, r)) << name << " row " << r;
                }
            }
        }
    }
}

TEST(Relaxation, SameForOneAndTwoThreads) {
    const Mesh mesh = shapes::scan(3000);
    Rings rings = rings_with_flaps(mesh);
    mark_features_by_angle(rings, mesh.positions, 20);
    for (const Operator op : all_operators) {
        set_thread_count(1);
        const Rows one = sparse_rows(rings, mesh.positions, with(op));
        set_thread_count(2);
        const Rows two = sparse_rows(rings, mesh.positions, with(op));
        EXPECT_EQ(one.column, two.column);
        EXPECT_EQ(one.weight, two.weight);
        EXPECT_EQ(one.fixed, two.fixed);
        const bool has_corners = op != Operator::second_difference && op != Operator::second_difference_flaps;
        EXPECT_EQ(one.fixed.empty(), !has_corners);
    }
    set_thread_count(0);
}

TEST(Relaxation, OpenRingsInterpolateAlongTheBoundary) {
    for (const Mesh& mesh : {shapes::plane(8), shapes::open_cylinder(9, 3), shapes::triangle()}) {
        const Rings rings = rings_with_flaps(mesh);
        for (const Operator op : all_operators) {
            if (uses_flaps(op)) continue;
            const Rows rows = sparse_rows(rings, mesh.positions, with(op));
            for (Index r = 0; r < rings.rows(); ++r) {
                if (rings.kind[r] != RingKind::open) continue;
                const Index first = rows.offset[r], last = first + rings.size(r) - 1;
                const double to_first = (mesh.positions[rows.column[first]] - mesh.positions[r]).norm();
                const double to_last = (mesh.positions[rows.column[last]] - mesh.positions[r]).norm();
                EXPECT_DOUBLE_EQ(rows.weight[first], to_last / (to_first + to_last));
                EXPECT_DOUBLE_EQ(rows.weight[last], to_first / (to_first + to_last));
                for (Index k = first + 1; k < last; ++k) EXPECT_EQ(rows.weight[k], 0);
            }
        }
    }
}

/// Weights of the vertex at 0 of a straight boundary, for those at `at`, ascending and two on either side; of no vertex
/// if it is infinite.
std::array<double, 4> weights_along_boundary(const std::array<double, 4>& at) {
    Positions p{{0, 0, 0}, {at[2], 0, 0}, {0, 1, 0}, {at[1], 0, 0}, {at[3], 0, 0}, {at[0], 0, 0}};
    Rings rings;
    rings.kind = {RingKind::open};
    rings.offset = {0, 3};
    rings.neighbor = {1, 2, 3};
    rings.flap = {std::isfinite(at[3]) ? 4 : 1, 2, std::isfinite(at[0]) ? 5 : 3};
    rings.vertices = {0};
    for (Vec3& q : p)
        if (!std::isfinite(q[0])) q[0] = 0;
    const RingWeights w = ring_weights(rings, p, with(Operator::second_difference_flaps));
    EXPECT_TRUE(w.fixed.empty());
    EXPECT_EQ(w.weight[1], 0);
    EXPECT_EQ(w.flap_weight[1], 0);
    return {w.flap_weight[2], w.weight[2], w.weight[0], w.flap_weight[0]};
}

TEST(Relaxation, OperatorsWithFlapsReproduceQuadraticsAlongTheBoundary) {
    const double none = std::numeric_limits<double>::infinity();
    const auto even = weights_along_boundary({-2, -1, 1, 2});
    const std::array<double, 4> expected{-1.0 / 6, 2.0 / 3, 2.0 / 3, -1.0 / 6};
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(even[k], expected[k], 1e-15);
    const auto straight = weights_along_boundary({-none, -1, 2, none});
    EXPECT_NEAR(straight[1], 2.0 / 3, 1e-15);
    EXPECT_NEAR(straight[2], 1.0 / 3, 1e-15);
    for (const std::array<double, 4>& at : {std::array<double, 4>{-3, -1, 2, 3.5},
                                            {-1.1, -1, 2, 4},
                                            {-none, -1, 2, 4},
                                            {-5, -1, 0.25, none},
                                            {-1, -1, 2, 4},
                                            {-1e-3, -1e-4, 50, 80}}) {
        const auto w = weights_along_boundary(at);
        double sum = 0, line = 0, square = 0, norm = 0;
        for (int k = 0; k < 4; ++k) {
            if (w[k] == 0) continue;
            sum += w[k], line += w[k] * at[k], square += w[k] * at[k] * at[k], norm += std::abs(w[k]);
        }
        EXPECT_NEAR(sum, 1, 1e-14);
        EXPECT_NEAR(line, 0, 1e-13);
        EXPECT_NEAR(square, 0, 1e-12);
        EXPECT_LT(norm, 10);
    }
    // Both next vertices next to nothing away: nearly linear interpolation.
    const auto crowded = weights_along_boundary({-1 - 1e-6, -1, 2, 2 + 1e-6});
    EXPECT_NEAR(crowded[0] + crowded[1], 2.0 / 3, 1e-5);
    for (const double w : crowded) EXPECT_LT(std::abs(w), 5);
}

/// What the row of a boundary vertex at 0 predicts from two neighbours and the vertices beyond them.
Vec3 predicted_on_boundary(const Vec3& a, const Vec3& b, const Vec3& beyond_a, const Vec3& beyond_b) {
    const Positions p{{0, 0, 0}, a, a + b, b, beyond_a, beyond_b};
    Rings rings;
    rings.kind = {RingKind::open};
    rings.offset = {0, 3};
    rings.neighbor = {1, 2, 3};
    rings.flap = {4, 2, 5};
    rings.vertices = {0};
    return relaxed(rings, ring_weights(rings, p, with(Operator::second_difference_flaps)), p)[0];
}

TEST(Relaxation, OperatorsWithFlapsCarryBothSidesOnToACornerOfTheBoundary) {
    const Vec3 x(1, 0, 0);
    const auto turned = [](double angle) { return Vec3(std::cos(angle), std::sin(angle), 0); };
    for (const double angle : {60.0, 90.0, 120.0}) {  // between the sides
        const Vec3 y = turned(radians(angle));
        EXPECT_LT(predicted_on_boundary(x, y, 2 * x, 2 * y).norm(), 1e-14) << angle;
        EXPECT_LT(predicted_on_boundary(x, 0.7 * y, 1.5 * x, 2 * y).norm(), 1e-14) << angle;
        // The neighbours of a corner stay on their side.
        EXPECT_LT(predicted_on_boundary(x, -x, x + y, -2 * x).norm(), 1e-14) << angle;
        // Bounded where there is next to nothing to carry on.
        EXPECT_LT(predicted_on_boundary(x, y, (1 + 1e-6) * x, (1 + 1e-6) * y).norm(), 1);
        EXPECT_LT(predicted_on_boundary(x, y, x, y).norm(), 1);
    }
    // A vertex that sticks out of a straight line is none: it goes back to the line.
    for (const double height : {0.2, 0.5, 1.0}) {
        const Vec3 up(0, height, 0);
        EXPECT_LT(predicted_on_boundary(x - up, -x - up, 2 * x - up, -2 * x - up).y(), -0.6 * height) << height;
    }
    // Nor is one on a circle, however few it has.
    for (const int n : {5, 6, 8, 20}) {
        const double step = 2 * pi / n;
        const auto at = [&](int k) { return Vec3(turned(k * step) - turned(0)); };
        const Vec3 p = predicted_on_boundary(at(1), at(-1), at(2), at(-2));
        EXPECT_LT(p.norm(), 0.55 * (1 - std::cos(step))) << n;
    }
}

TEST(Relaxation, RelaxedKeepsTheValuesOfFixedRows) {
    const Mesh mesh = shapes::unreferenced_vertices();
    const Rings rings = rings_with_flaps(mesh);
    const Positions result = relaxed(rings, ring_weights(rings, mesh.positions), mesh.positions);
    EXPECT_EQ(result[0], mesh.positions[0]);
    EXPECT_EQ(result.back(), mesh.positions.back());
    EXPECT_NE(result[1], mesh.positions[1]);
}

TEST(Relaxation, CreasesAndCorners) {
    // Neighbours of vertex 0 at distances 1 and 2 along the crease, and two more.
    ClosedStar star({{0, 0, 0}, {1, 0, 0}, {0, 1, -1}, {-2, 0, 0}, {0, -1, -1}});
    for (const Operator op : {Operator::umbrella, Operator::cotangent, Operator::cotangent_clamped,
                              Operator::cotangent_delaunay, Operator::natural_neighbours, Operator::thin_plate}) {
        star.rings.feature = {1, 0, 1, 0};
        EXPECT_EQ(star.weights(op), (Array<double>{2.0 / 3, 0, 1.0 / 3, 0}));
        for (const Array<std::uint8_t>& corner : {Array<std::uint8_t>{1, 0, 0, 0}, {1, 1, 1, 0}}) {
            star.rings.feature = corner;
            const RingWeights kept = ring_weights(star.rings, star.positions, with(op));
            EXPECT_EQ(kept.fixed, std::vector<Index>{0});
            EXPECT_EQ(kept.weight, Array<double>(4, 0));
        }
        star.rings.feature = {0, 0, 0, 0};
        EXPECT_TRUE(ring_weights(star.rings, star.positions, with(op)).fixed.empty());
    }
    star.rings.feature = {1, 1, 1, 1};  // nothing is left of the sum
    EXPECT_EQ(ring_weights(star.rings, star.positions, with(Operator::second_difference)).fixed, std::vector<Index>{0});
}

TEST(Relaxation, CreaseMeetingTheBoundaryIsFixed) {
    ClosedStar star({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}});
    star.rings.kind = {RingKind::open};
    for (const Operator op : {Operator::cotangent, Operator::second_difference}) {
        star.rings.feature = {1, 0, 1};  // along the boundary
        EXPECT_EQ(star.weights(op), (Array<double>{0.5, 0, 0.5}));
        star.rings.feature = {0, 1, 0};
        EXPECT_EQ(ring_weights(star.rings, star.positions, with(op)).fixed, std::vector<Index>{0});
    }
}

TEST(Relaxation, StarsOfDegenerateTrianglesFallBackOnLengths) {
    const ClosedStar line({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {4, 0, 0}});
    const ClosedStar point({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {4, 0, 0}});
    for (const Operator op : {Operator::cotangent, Operator::cotangent_clamped, Operator::cotangent_delaunay,
                              Operator::second_difference, Operator::natural_neighbours, Operator::thin_plate}) {
        const std::vector<double> inverse{4.0 / 7, 2.0 / 7, 1.0 / 7};
        const Array<double> w = line.weights(op);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(w[k], inverse[k], 1e-15);
        EXPECT_EQ(point.weights(op), (Array<double>{0.5, 0.5, 0}));
    }
}

TEST(Relaxation, RowsThatWouldMagnifyRoundingAreThoseOfDelaunay) {
    // A tall sliver on either side of the vertex: its plain cotangents are about 1 / height.
    const double height = 1e-4;
    const ClosedStar star({{0, 0, 0}, {1, 0, 0}, {0.4, height, 0}, {-1, 1, 0}, {-0.5, -1, 0}, {0.5, -height, 0}});
    for (const Operator op : {Operator::cotangent, Operator::second_difference}) {
        RelaxationOptions options = with(op);
        const auto norm = [&] {
            double sum = 0;
            for (const double w : ring_weights(star.rings, star.positions, options).weight) sum += std::abs(w);
            return sum;
        };
        options.largest_norm = std::numeric_limits<double>::infinity();
        EXPECT_GT(norm(), 2) << static_cast<int>(op);
        options.largest_norm = 0.99 * norm();
        EXPECT_EQ(ring_weights(star.rings, star.positions, options).weight, star.weights(Operator::cotangent_delaunay));
        options.largest_norm = 1.01 * options.largest_norm / 0.99;
        EXPECT_NE(ring_weights(star.rings, star.positions, options).weight, star.weights(Operator::cotangent_delaunay));
    }
}

TEST(Relaxation, FlapsAreRefusedWhereTheyCannotBe) {
    const ClosedStar star(planar_star(5, 1));
    EXPECT_THROW(ring_weights(star.rings, star.positions, with(Operator::second_difference_flaps)),
                 std::invalid_argument);
}

TEST(Relaxation, LargeFansHaveRows) {
    const Mesh mesh = shapes::fan(5000, 0.1);
    const Rings rings = rings_with_flaps(mesh);
    for (const Operator op : all_operators) {
        const Rows rows = sparse_rows(rings, mesh.positions, with(op));
        ASSERT_EQ(rows.offset[1], 5000);
        // Second differences subtract cotangents of about n / 2 pi from each other to leave a millionth of them, and
        // each is rounded to about n^2 epsilon: 4 digits are left.
        const bool subtracts = op == Operator::second_difference || op == Operator::second_difference_flaps;
        const double digits = subtracts ? 1e-3 : 1e-8;
        for (Index k = 0; k < 5000; ++k) EXPECT_NEAR(5000 * rows.weight[k], 1, digits);
    }
}

}  // namespace multires
