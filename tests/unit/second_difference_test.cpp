#include "operator_fixtures.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

namespace multires {

using namespace fixtures;

namespace {

/// The jump of the gradient across the edge {j, k} of the piecewise linear function g over two triangles in the plane:
/// Guskov's second-order difference, from its definition.
double gradient_jump(const Vec3 (&p)[4], const double (&g)[4]) {  // j, k, l1, l2
    const auto gradient = [&](int l) {
        Eigen::Matrix2d edges;
        edges.row(0) = (p[1] - p[0]).head<2>();
        edges.row(1) = (p[l] - p[0]).head<2>();
        return Eigen::Vector2d(edges.inverse() * Eigen::Vector2d(g[1] - g[0], g[l] - g[0]));
    };
    const Eigen::Vector2d along = (p[1] - p[0]).head<2>().normalized(), across(-along.y(), along.x());
    return (gradient(2) - gradient(3)).dot(across);
}

/// Lays two triangles of space into the plane, hinged at their common edge.
void flatten(const Vec3 (&space)[4], Vec3 (&flat)[4]) {
    const double length = (space[1] - space[0]).norm();
    flat[0] = Vec3::Zero();
    flat[1] = Vec3(length, 0, 0);
    for (int l = 2; l < 4; ++l) {
        const double x = (space[l] - space[0]).dot(space[1] - space[0]) / length;
        const double y = std::sqrt(std::max(0.0, (space[l] - space[0]).squaredNorm() - x * x));
        flat[l] = Vec3(x, l == 2 ? y : -y, 0);
    }
}

/// Minimises the sum of squared second-order differences over the value at a vertex by brute force: each difference is
/// evaluated for the unit functions of its four vertices, the least squares problem is left to Eigen.
std::map<Index, double> minimiser(const Rings& rings, Index r, const Positions& positions, bool links) {
    const Index v = rings.vertex(r), n = rings.size(r);
    std::vector<std::map<Index, double>> equations;
    const auto add = [&](Index j, Index k, Index l1, Index l2) {
        const Index corner[4] = {j, k, l1, l2};
        const Vec3 space[4] = {positions[j], positions[k], positions[l1], positions[l2]};
        Vec3 flat[4];
        flatten(space, flat);
        std::map<Index, double> equation;
        for (int c = 0; c < 4; ++c) {
            double unit[4] = {0, 0, 0, 0};
            unit[c] = 1;
            equation[corner[c]] += gradient_jump(flat, unit);
        }
        equations.push_back(equation);
    };
    for (Index j = 0; j < n; ++j) {
        const Index* ring = rings.begin(r);
        add(v, ring[j], ring[(j + n - 1) % n], ring[(j + 1) % n]);
        const Index entry = rings.offset[r] + j;
        if (links && rings.has_flap(entry)) add(ring[j], ring[(j + 1) % n], v, rings.flap[entry]);
    }
    Eigen::VectorXd own(equations.size());
    std::map<Index, Eigen::VectorXd> columns;
    for (std::size_t e = 0; e < equations.size(); ++e) {
        own[e] = equations[e].at(v);
        for (const auto& [vertex, value] : equations[e]) {
            if (vertex == v) continue;
            columns.try_emplace(vertex, Eigen::VectorXd::Zero(equations.size())).first->second[e] = value;
        }
    }
    std::map<Index, double> weights;
    const auto solver = own.colPivHouseholderQr();
    for (const auto& [vertex, column] : columns) weights[vertex] = solver.solve(-column)[0];
    return weights;
}

}  // namespace

TEST(SecondDifference, MinimisesTheSumOfSquares) {
    for (const Mesh& mesh : {shapes::scan(400), shapes::plane(10), shapes::tetrahedron(), shapes::valence_three(),
                             shapes::torus(5, 4), shapes::icosphere(1), shapes::fan(7, 0.5)}) {
        const Rings rings = rings_with_flaps(mesh);
        for (const bool links : {false, true}) {
            const Rows rows = sparse_rows(
                rings, mesh.positions, with(links ? Operator::second_difference_flaps : Operator::second_difference));
            for (Index r = 0; r < rings.rows(); ++r) {
                if (rings.kind[r] != RingKind::closed) continue;
                std::map<Index, double> expected = minimiser(rings, r, mesh.positions, links);
                for (Index k = rows.offset[r]; k < rows.offset[r + 1]; ++k) {
                    EXPECT_NEAR(rows.weight[k], expected[rows.column[k]], 1e-10) << "row " << r;
                    expected.erase(rows.column[k]);
                }
                EXPECT_TRUE(expected.empty()) << "row " << r << " misses a vertex";
            }
        }
    }
}

TEST(SecondDifference, OneEdgeGivesTheCoefficientsOfThePaper) {
    // With every edge but one left out, the weights are -c_e,j / c_e,i: Guskov's coefficients (eq. 1) of that edge.
    // As printed, A[k,l1,l2] and A[j,l2,l1] have the wrong sign (the four would not sum to 0): l1 and l2 are swapped.
    Mesh mesh = shapes::scan(100);
    Rings rings = rings_with_flaps(mesh);
    const Rings whole = rings;
    rings.feature.assign(rings.neighbor.size(), 1);
    rings.flap = rings.neighbor;  // none
    RelaxationOptions options = with(Operator::second_difference_flaps);
    options.largest_norm = std::numeric_limits<double>::infinity();
    const auto area = [](const Vec3& a, const Vec3& b, const Vec3& c) { return 0.5 * (b - a).cross(c - a).z(); };
    for (Index r = 0; r < rings.rows(); ++r) {
        const Index n = rings.size(r), *ring = rings.begin(r), at = rings.offset[r];
        for (const bool link : {false, true}) {
            // Spoke {v, ring[1]} or link edge {ring[0], ring[1]}.
            const Index j = link ? ring[0] : r, k = ring[1], l1 = link ? r : ring[0],
                        l2 = link ? whole.flap[at] : ring[2];
            if (link) {
                rings.flap[at] = l2;
            } else {
                rings.feature[at + 1] = 0;
            }
            Vec3 p[4];
            flatten({mesh.positions[j], mesh.positions[k], mesh.positions[l1], mesh.positions[l2]}, p);
            const double length = (p[1] - p[0]).norm(), a1 = area(p[2], p[1], p[0]), a2 = area(p[3], p[0], p[1]);
            std::map<Index, double> c;
            c[l1] = length / a1;
            c[l2] = length / a2;
            c[j] = -length * area(p[1], p[3], p[2]) / (a1 * a2);
            c[k] = -length * area(p[0], p[2], p[3]) / (a1 * a2);
            EXPECT_NEAR(c[l1] + c[l2] + c[j] + c[k], 0, 1e-12 * length / std::abs(a1));

            const Rows rows = sparse_rows(rings, mesh.positions, options);
            ASSERT_FALSE(is_fixed(rows.fixed, r));
            for (Index e = rows.offset[r]; e < rows.offset[r + 1]; ++e) {
                EXPECT_NEAR(rows.weight[e], -c[rows.column[e]] / c[r], 1e-11 * largest_weight(rows, r));
            }
            rings.flap[at] = ring[0];
            rings.feature[at + 1] = 1;
        }
        ASSERT_GE(n, 4);
    }
}

TEST(SecondDifference, FeatureEdgesAreLeftOut) {
    // A roof: two planes that meet in the crease along x. With the crease left out of the sum both are flat, so the
    // vertex keeps its place; with it the roof is pulled down.
    ClosedStar star({{0, 0, 0}, {1, 0, 0}, {0.4, 1, -1}, {-0.6, 1, -1}, {-1, 0, 0}, {-0.3, -1, -1}, {0.5, -1, -1}});
    const auto offset = [&] {
        const Array<double> w = star.weights(Operator::second_difference);
        Vec3 sum = Vec3::Zero();
        for (int k = 0; k < 6; ++k) sum += w[k] * star.positions[k + 1];
        return sum;
    };
    EXPECT_LT(offset().z(), -0.1);
    star.rings.feature = {1, 0, 0, 1, 0, 0};
    EXPECT_LT(offset().norm(), 1e-14);
}

TEST(SecondDifference, EdgesOfDegenerateTrianglesAreLeftOut) {
    // As above, but the spokes along the crease lie between triangles of no area: neighbours 2 and 8 repeat 1, 5
    // repeats 4.
    const ClosedStar star({{0, 0, 0},
                           {1, 0, 0},
                           {1, 0, 0},
                           {0.4, 1, -1},
                           {-0.6, 1, -1},
                           {-1, 0, 0},
                           {-1, 0, 0},
                           {-0.3, -1, -1},
                           {0.5, -1, -1}});
    const Array<double> w = star.weights(Operator::second_difference);
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 8; ++k) sum += w[k] * star.positions[k + 1];
    EXPECT_LT(sum.norm(), 1e-14);
}

TEST(SecondDifference, FlapsThatOccurTwiceCountTwice) {
    // A cone of n triangles whose link edges continue to a second ring, of which every flap vertex occurs twice.
    for (const Index n : {10, 300}) {
        Mesh mesh = shapes::fan(n, 0.5);
        for (Index j = 0; j < n; ++j) {
            const Index j1 = 1 + j, j2 = 1 + (j + 1) % n, flap = n + 1 + j / 2;
            if (j % 2 == 0) mesh.positions.push_back(2 * mesh.positions[j2] - Vec3(0, 0, 1));
            mesh.faces.push_back({j2, j1, flap});
        }
        const Rings rings = rings_with_flaps(mesh);
        ASSERT_EQ(rings.kind[0], RingKind::closed);
        const Rows rows = sparse_rows(rings, mesh.positions, with(Operator::second_difference_flaps));
        std::map<Index, double> expected = minimiser(rings, 0, mesh.positions, true);
        ASSERT_EQ(static_cast<Index>(expected.size()), n + n / 2);
        ASSERT_EQ(rows.offset[1], n + n / 2);
        for (Index k = 0; k < rows.offset[1]; ++k) EXPECT_NEAR(rows.weight[k], expected.at(rows.column[k]), 1e-9);
    }
}

}  // namespace multires
