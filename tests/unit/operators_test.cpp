#include "operators/relaxation.h"

#include "mesh/adjacency.h"
#include "random.h"
#include "shapes.h"

#include "parallel/parallel.h"
#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace multires {
namespace {

constexpr Operator all_operators[] = {Operator::umbrella,          Operator::cotangent,
                                      Operator::cotangent_clamped, Operator::cotangent_delaunay,
                                      Operator::second_difference, Operator::second_difference_flaps};
constexpr Operator linear_precise[] = {Operator::cotangent, Operator::cotangent_delaunay, Operator::second_difference,
                                       Operator::second_difference_flaps};

RelaxationOptions with(Operator op) {
    RelaxationOptions options;
    options.op = op;
    return options;
}

Rings rings_of(const Mesh& mesh) {
    Rings rings = vertex_rings(mesh);
    find_flaps(rings);
    return rings;
}

/// A closed star around vertex 0 whose ring is 1, 2, ..., n.
struct ClosedStar {
    explicit ClosedStar(Positions p) : positions(std::move(p)) {
        rings.offset = {0, static_cast<Index>(positions.size()) - 1};
        for (Index v = 1; v < static_cast<Index>(positions.size()); ++v) rings.neighbor.push_back(v);
        rings.kind = {RingKind::closed};
    }
    std::vector<double> weights(Operator op) const { return ring_weights(rings, positions, with(op)).weight; }

    Positions positions;
    Rings rings;
};

/// n points at random distances and increasing angles around the origin, all gaps below 180 degrees; the origin first.
Positions planar_star(Index n, std::uint64_t seed) {
    shapes::Random random(seed);
    Positions p{Vec3::Zero()};
    for (Index j = 0; j < n; ++j) {
        const double angle = 2 * std::acos(-1.0) * (j + random.uniform(0, 0.9)) / n, r = random.uniform(0.1, 2);
        p.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
    }
    return p;
}

bool is_kept(const std::vector<Index>& kept, Index row) { return std::binary_search(kept.begin(), kept.end(), row); }

double sum_of_row(const Rows& rows, Index r) {
    double sum = 0;
    for (Index k = rows.offset[r]; k < rows.offset[r + 1]; ++k) sum += rows.weight[k];
    return sum;
}

double largest_weight(const Rows& rows, Index r) {
    double largest = 1;
    for (Index k = rows.offset[r]; k < rows.offset[r + 1]; ++k) largest = std::max(largest, std::abs(rows.weight[k]));
    return largest;
}

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
        const Index flap = rings.flap[rings.offset[r] + j];
        if (links && flap >= 0) add(ring[j], ring[(j + 1) % n], v, flap);
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

TEST(Relaxation, RowsSumToOneOrAreKept) {
    for (const auto& [name, mesh] : shapes::every_class()) {
        const Rings rings = rings_of(mesh);
        for (const Operator op : all_operators) {
            const Rows rows = relaxation(rings, mesh.positions, with(op));
            ASSERT_EQ(rows.offset.size(), rings.kind.size() + 1);
            for (Index r = 0; r < rings.rows(); ++r) {
                const double expected = is_kept(rows.kept, r) ? 0 : 1;
                EXPECT_NEAR(sum_of_row(rows, r), expected, 1e-14 * largest_weight(rows, r) * (1 + rings.size(r)))
                    << name << " operator " << static_cast<int>(op) << " row " << r;
            }
        }
    }
}

TEST(Relaxation, WithoutFeaturesExactlyTheRowsWithoutRingAreKept) {
    for (const auto& [name, mesh] : shapes::every_class()) {
        const Rings rings = rings_of(mesh);
        std::vector<Index> without;
        for (Index r = 0; r < rings.rows(); ++r) {
            if (rings.kind[r] == RingKind::irregular || rings.kind[r] == RingKind::isolated) without.push_back(r);
        }
        for (const Operator op : all_operators)
            EXPECT_EQ(relaxation(rings, mesh.positions, with(op)).kept, without) << name;
    }
}

TEST(Relaxation, LinearFunctionsOfPlanarMeshesAreReproduced) {
    for (const Mesh& mesh : {shapes::plane(30), shapes::disk(15), shapes::plane(10, {0, 0, 1}), shapes::fan(300)}) {
        const Rings rings = rings_of(mesh);
        for (const Operator op : linear_precise) {
            const Rows rows = relaxation(rings, mesh.positions, with(op));
            const Positions result = relaxed(rings, rows, mesh.positions);
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

TEST(Relaxation, UmbrellaMovesVerticesWithinThePlane) {
    const Mesh mesh = shapes::plane(30);
    const Rings rings = rings_of(mesh);
    const Positions result =
        relaxed(rings, ring_weights(rings, mesh.positions, with(Operator::umbrella)), mesh.positions);
    double largest = 0;
    for (Index r = 0; r < rings.rows(); ++r) {
        if (rings.kind[r] == RingKind::closed) largest = std::max(largest, (result[r] - mesh.positions[r]).norm());
    }
    EXPECT_GT(largest, 0.1 / 30);
}

TEST(Relaxation, WeightsNonnegativeWherePromised) {
    for (const auto& [name, mesh] : shapes::every_class()) {
        const Rings rings = rings_of(mesh);
        for (const Operator op : {Operator::umbrella, Operator::cotangent_clamped, Operator::cotangent_delaunay}) {
            for (const double w : ring_weights(rings, mesh.positions, with(op)).weight) {
                EXPECT_GE(w, 0) << name;
                EXPECT_LE(w, 1) << name;
            }
        }
    }
    const Mesh mesh = shapes::plane(30);  // the plain weights of this mesh are not all positive
    const auto plain = ring_weights(rings_of(mesh), mesh.positions, with(Operator::cotangent)).weight;
    EXPECT_LT(*std::min_element(plain.begin(), plain.end()), -0.01);
}

TEST(Relaxation, SameUnderRotationTranslationScalingAndReflection) {
    const Eigen::AngleAxisd turn(1.1, Vec3(1, 2, 3).normalized());
    for (const auto& [name, mesh] : shapes::every_class()) {
        if (name == "collinear_faces" || name == "coincident_vertices") continue;  // degenerate up to rounding
        const Rings rings = rings_of(mesh);
        Positions moved(mesh.positions);
        for (Vec3& p : moved) p = 1000 * (turn * Vec3(p.x(), p.y(), -p.z())) + Vec3(10, -20, 30);
        for (const Operator op : all_operators) {
            const Rows a = relaxation(rings, mesh.positions, with(op)), b = relaxation(rings, moved, with(op));
            ASSERT_EQ(a.column, b.column);
            EXPECT_EQ(a.kept, b.kept) << name;
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
    Rings rings = rings_of(mesh);
    mark_features_by_angle(rings, mesh.positions, 20);
    const int threads = thread_count();
    for (const Operator op : all_operators) {
        set_thread_count(1);
        const Rows one = relaxation(rings, mesh.positions, with(op));
        set_thread_count(2);
        const Rows two = relaxation(rings, mesh.positions, with(op));
        EXPECT_EQ(one.column, two.column);
        EXPECT_EQ(one.weight, two.weight);
        EXPECT_EQ(one.kept, two.kept);
        const bool has_corners = op != Operator::second_difference && op != Operator::second_difference_flaps;
        EXPECT_EQ(one.kept.empty(), !has_corners);
    }
    set_thread_count(threads);
}

TEST(Relaxation, OpenRingsInterpolateAlongTheBoundary) {
    for (const Mesh& mesh : {shapes::plane(8), shapes::open_cylinder(9, 3), shapes::triangle()}) {
        const Rings rings = rings_of(mesh);
        for (const Operator op : all_operators) {
            const Rows rows = relaxation(rings, mesh.positions, with(op));
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

TEST(Relaxation, RelaxedKeepsTheValuesOfKeptRows) {
    const Mesh mesh = shapes::unreferenced_vertices();
    const Rings rings = rings_of(mesh);
    const Positions result = relaxed(rings, ring_weights(rings, mesh.positions), mesh.positions);
    EXPECT_EQ(result[0], mesh.positions[0]);
    EXPECT_EQ(result.back(), mesh.positions.back());
    EXPECT_NE(result[1], mesh.positions[1]);
}

TEST(Relaxation, CreasesAndCorners) {
    // Neighbours of vertex 0 at distances 1 and 2 along the crease, and two more.
    ClosedStar star({{0, 0, 0}, {1, 0, 0}, {0, 1, -1}, {-2, 0, 0}, {0, -1, -1}});
    for (const Operator op :
         {Operator::umbrella, Operator::cotangent, Operator::cotangent_clamped, Operator::cotangent_delaunay}) {
        star.rings.feature = {1, 0, 1, 0};
        EXPECT_EQ(star.weights(op), (std::vector<double>{2.0 / 3, 0, 1.0 / 3, 0}));
        for (const std::vector<std::uint8_t>& corner : {std::vector<std::uint8_t>{1, 0, 0, 0}, {1, 1, 1, 0}}) {
            star.rings.feature = corner;
            const RingWeights kept = ring_weights(star.rings, star.positions, with(op));
            EXPECT_EQ(kept.kept, std::vector<Index>{0});
            EXPECT_EQ(kept.weight, std::vector<double>(4, 0));
        }
        star.rings.feature = {0, 0, 0, 0};
        EXPECT_TRUE(ring_weights(star.rings, star.positions, with(op)).kept.empty());
    }
    star.rings.feature = {1, 1, 1, 1};  // nothing is left of the sum
    EXPECT_EQ(ring_weights(star.rings, star.positions, with(Operator::second_difference)).kept, std::vector<Index>{0});
}

TEST(Relaxation, CreaseMeetingTheBoundaryIsKept) {
    ClosedStar star({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}});
    star.rings.kind = {RingKind::open};
    for (const Operator op : {Operator::cotangent, Operator::second_difference}) {
        star.rings.feature = {1, 0, 1};  // along the boundary
        EXPECT_EQ(star.weights(op), (std::vector<double>{0.5, 0, 0.5}));
        star.rings.feature = {0, 1, 0};
        EXPECT_EQ(ring_weights(star.rings, star.positions, with(op)).kept, std::vector<Index>{0});
    }
}

TEST(Relaxation, StarsOfDegenerateTrianglesFallBackOnLengths) {
    const ClosedStar line({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {4, 0, 0}});
    const ClosedStar point({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {4, 0, 0}});
    for (const Operator op : {Operator::cotangent, Operator::cotangent_clamped, Operator::cotangent_delaunay,
                              Operator::second_difference}) {
        const std::vector<double> inverse{4.0 / 7, 2.0 / 7, 1.0 / 7};
        const std::vector<double> w = line.weights(op);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(w[k], inverse[k], 1e-15);
        EXPECT_EQ(point.weights(op), (std::vector<double>{0.5, 0.5, 0}));
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
    EXPECT_THROW(relaxation(star.rings, star.positions, with(Operator::second_difference_flaps)),
                 std::invalid_argument);
}

TEST(Cotangent, WeightsAreThoseOfTheAngles) {
    const Mesh mesh = shapes::scan(500);
    const Rings rings = rings_of(mesh);
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
    const std::vector<double> w = star.weights(Operator::cotangent);
    for (int k = 0; k < 5; ++k) EXPECT_NEAR(w[k], expected[k] / sum, 1e-15) << k;
}

TEST(Cotangent, ClampedIsBoundedOnSlivers) {
    const double height = 1e-7;
    const ClosedStar star({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, -height, 0}, {0, -1, 0}, {0.5, -height, 0}});
    const auto largest = [](const std::vector<double>& w) { return *std::max_element(w.begin(), w.end()); };
    const auto least = [](const std::vector<double>& w) { return *std::min_element(w.begin(), w.end()); };
    EXPECT_LT(least(star.weights(Operator::cotangent)), -0.1);
    EXPECT_EQ(least(star.weights(Operator::cotangent_clamped)), 0);
    EXPECT_LE(largest(star.weights(Operator::cotangent_clamped)), 1);
}

TEST(Cotangent, DelaunayEqualsPlainOnDelaunayMeshes) {
    const Mesh mesh = shapes::icosphere(8);
    const Rings rings = rings_of(mesh);
    EXPECT_EQ(ring_weights(rings, mesh.positions, with(Operator::cotangent_delaunay)).weight,
              ring_weights(rings, mesh.positions, with(Operator::cotangent)).weight);
}

TEST(Cotangent, DelaunayKeepsTheSpokesToTheConvexHullUnderInversion) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const ClosedStar star(planar_star(4 + seed % 20, seed));
        const std::vector<double> w = star.weights(Operator::cotangent_delaunay);
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
    EXPECT_EQ(on_edge.weights(Operator::cotangent_delaunay), (std::vector<double>{0.75, 0.25, 0}));
    // Neighbour 2 lies behind neighbour 3, or the other way round.
    for (const int behind : {1, 2}) {
        Positions p{{0, 0, 0}, {0, -1, 0}, {1, 0, 0}, {1, 0, 0}, {0, 3, 0}, {-1, 0, 0}};
        p[1 + behind].x() = 2;
        const std::vector<double> w = ClosedStar(p).weights(Operator::cotangent_delaunay);
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
                const std::vector<double> one = star.weights(op);
                std::vector<double> two = ClosedStar(doubled).weights(op);
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
        EXPECT_EQ(star.weights(op), (std::vector<double>{0, 0.25, 0.5, 0.25}));
    }
}

TEST(Cotangent, DegenerateIsRelativeToTheEdges) {
    // The vertex lies at this height above the edge between neighbours 1 and 3, whose length is 2.
    for (const double scale : {1e-30, 1.0, 1e30}) {
        for (const double height : {1e-12, 1e-8}) {
            Positions p{{0, 0, 0}, {1, -height, 0}, {0, 1, 0}, {-1, -height, 0}};
            for (Vec3& q : p) q *= scale;
            const std::vector<double> w = ClosedStar(p).weights(Operator::cotangent);
            if (height < 1e-10) {  // left out: half a star, as above
                for (int k = 0; k < 3; ++k) EXPECT_NEAR(w[k], k == 1 ? 0.5 : 0.25, 1e-11);
            } else {  // in: interpolation along the edge
                for (int k = 0; k < 3; ++k) EXPECT_NEAR(w[k], k == 1 ? 0 : 0.5, 1e-7);
            }
        }
    }
}

TEST(SecondDifference, MinimisesTheSumOfSquares) {
    for (const Mesh& mesh : {shapes::scan(400), shapes::plane(10), shapes::tetrahedron(), shapes::valence_three(),
                             shapes::torus(5, 4), shapes::icosphere(1), shapes::fan(7, 0.5)}) {
        const Rings rings = rings_of(mesh);
        for (const bool links : {false, true}) {
            const Rows rows = relaxation(rings, mesh.positions,
                                         with(links ? Operator::second_difference_flaps : Operator::second_difference));
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
    Rings rings = rings_of(mesh);
    const Rings whole = rings;
    rings.feature.assign(rings.neighbor.size(), 1);
    rings.flap.assign(rings.neighbor.size(), -1);
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

            const Rows rows = relaxation(rings, mesh.positions, options);
            ASSERT_FALSE(is_kept(rows.kept, r));
            for (Index e = rows.offset[r]; e < rows.offset[r + 1]; ++e) {
                EXPECT_NEAR(rows.weight[e], -c[rows.column[e]] / c[r], 1e-11 * largest_weight(rows, r));
            }
            rings.flap[at] = -1;
            rings.feature[at + 1] = 1;
        }
        ASSERT_GE(n, 4);
    }
}

TEST(SecondDifference, ColumnsAreTheRingThenTheOtherFlapsOnce) {
    for (const Mesh& mesh : {shapes::scan(400), shapes::torus(5, 4), shapes::icosphere(1)}) {
        const Rings rings = rings_of(mesh);
        const Rows rows = relaxation(rings, mesh.positions, with(Operator::second_difference_flaps));
        for (Index r = 0; r < rings.rows(); ++r) {
            std::vector<Index> expected(rings.begin(r), rings.begin(r) + rings.size(r));
            for (Index k = rings.offset[r]; k < rings.offset[r + 1]; ++k) {
                const Index f = rings.flap[k];
                if (f >= 0 && std::find(expected.begin(), expected.end(), f) == expected.end()) expected.push_back(f);
            }
            const std::vector<Index> columns(rows.column.begin() + rows.offset[r],
                                             rows.column.begin() + rows.offset[r + 1]);
            EXPECT_EQ(columns, expected);
        }
    }
}

TEST(SecondDifference, FeatureEdgesAreLeftOut) {
    // A roof: two planes that meet in the crease along x. With the crease left out of the sum both are flat, so the
    // vertex keeps its place; with it the roof is pulled down.
    ClosedStar star({{0, 0, 0}, {1, 0, 0}, {0.4, 1, -1}, {-0.6, 1, -1}, {-1, 0, 0}, {-0.3, -1, -1}, {0.5, -1, -1}});
    const auto offset = [&] {
        const std::vector<double> w = star.weights(Operator::second_difference);
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
    const std::vector<double> w = star.weights(Operator::second_difference);
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 8; ++k) sum += w[k] * star.positions[k + 1];
    EXPECT_LT(sum.norm(), 1e-14);
}

TEST(Relaxation, LargeFansHaveRows) {
    const Mesh mesh = shapes::fan(5000, 0.1);
    const Rings rings = rings_of(mesh);
    for (const Operator op : all_operators) {
        const Rows rows = relaxation(rings, mesh.positions, with(op));
        ASSERT_EQ(rows.offset[1], 5000);
        // Second differences subtract cotangents of about n / 2 pi from each other to leave a millionth of them, and
        // each is rounded to about n^2 epsilon: 4 digits are left.
        const bool subtracts = op == Operator::second_difference || op == Operator::second_difference_flaps;
        const double digits = subtracts ? 1e-3 : 1e-8;
        for (Index k = 0; k < 5000; ++k) EXPECT_NEAR(5000 * rows.weight[k], 1, digits);
    }
}

TEST(Relaxation, LargeRowsMergeFlapsAsSmallOnesDo) {
    // A cone of n triangles whose link edges continue to a second ring, of which every flap vertex occurs twice.
    for (const Index n : {10, 300}) {
        Mesh mesh = shapes::fan(n, 0.5);
        for (Index j = 0; j < n; ++j) {
            const Index j1 = 1 + j, j2 = 1 + (j + 1) % n, flap = n + 1 + j / 2;
            if (j % 2 == 0) mesh.positions.push_back(2 * mesh.positions[j2] - Vec3(0, 0, 1));
            mesh.faces.push_back({j2, j1, flap});
        }
        const Rings rings = rings_of(mesh);
        ASSERT_EQ(rings.kind[0], RingKind::closed);
        const Rows rows = relaxation(rings, mesh.positions, with(Operator::second_difference_flaps));
        ASSERT_EQ(rows.offset[1], n + n / 2);
        std::map<Index, double> expected = minimiser(rings, 0, mesh.positions, true);
        for (Index k = 0; k < rows.offset[1]; ++k) EXPECT_NEAR(rows.weight[k], expected.at(rows.column[k]), 1e-9);
    }
}

}  // namespace multires
