#include "shapes.h"

#include "measure/measure.h"
#include "mesh/adjacency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace multires {
namespace {

Index count(const Rings& rings, RingKind kind) {
    return static_cast<Index>(std::count(rings.kind.begin(), rings.kind.end(), kind));
}

Index euler_characteristic(const Mesh& mesh) {
    std::set<std::pair<Index, Index>> edges;
    for (const Face& f : mesh.faces) {
        for (int k = 0; k < 3; ++k) edges.insert(std::minmax(f[k], f[(k + 1) % 3]));
    }
    return static_cast<Index>(mesh.positions.size()) - static_cast<Index>(edges.size()) +
           static_cast<Index>(mesh.faces.size());
}

/// Every edge is used once in each direction: closed and consistently oriented.
void expect_closed_oriented(const Mesh& mesh) {
    std::set<std::pair<Index, Index>> edges;
    for (const Face& f : mesh.faces) {
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(edges.insert({f[k], f[(k + 1) % 3]}).second);
    }
    for (const auto& [a, b] : edges) EXPECT_EQ(edges.count({b, a}), 1u);
}

double mean(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t v = 0; v < a.size(); ++v) sum += a[v] * b[v];
    return sum / static_cast<double>(a.size());
}

}  // namespace

TEST(Shapes, SpheresAreClosedAndOutward) {
    for (const Mesh& mesh : {shapes::icosphere(1), shapes::icosphere(2), shapes::icosphere(7),
                             shapes::irregular_sphere(1000), shapes::scan(1000)}) {
        expect_closed_oriented(mesh);
        EXPECT_EQ(euler_characteristic(mesh), 2);
        EXPECT_EQ(count(vertex_rings(mesh), RingKind::closed), static_cast<Index>(mesh.positions.size()));
        for (const Face& f : mesh.faces) {
            const Vec3 &a = mesh.positions[f[0]], &b = mesh.positions[f[1]], &c = mesh.positions[f[2]];
            EXPECT_GT((b - a).cross(c - a).dot(a + b + c), 0);
        }
    }
}

TEST(Shapes, IcosphereHasTheStatedSize) {
    EXPECT_EQ(shapes::icosphere(7).positions.size(), 492u);
    for (const Vec3& p : shapes::icosphere(7).positions) EXPECT_NEAR(p.norm(), 1, 1e-15);
    const Rings rings = vertex_rings(shapes::icosphere(7));
    Index five = 0;
    for (Index r = 0; r < rings.rows(); ++r) {
        five += rings.size(r) == 5;
        EXPECT_TRUE(rings.size(r) == 5 || rings.size(r) == 6);
    }
    EXPECT_EQ(five, 12);
    EXPECT_EQ(shapes::irregular_sphere(1000).positions.size(), 1002u);
}

TEST(Shapes, IrregularMeansOtherValences) {
    const Rings rings = vertex_rings(shapes::irregular_sphere(5000));
    Index other = 0;
    for (Index r = 0; r < rings.rows(); ++r) {
        other += rings.size(r) != 6;
        EXPECT_GE(rings.size(r), 4);
    }
    EXPECT_GT(other, rings.rows() / 4);
}

TEST(Shapes, PlanarOnesCoverTheirAreaOnceFaceUp) {
    const double hexagons = 0.5 * 6 * 20 * std::sin(2 * std::acos(-1.0) / (6 * 20));
    for (const auto& [mesh, area] : {std::pair<Mesh, double>{shapes::plane(20), 1},
                                     {shapes::plane(1), 1},
                                     {shapes::plane(20, {0, 0, 1}), 1},
                                     {shapes::disk(20, {0, 0.5, 3}), hexagons}}) {
        EXPECT_NEAR(surface(mesh.faces, mesh.positions).area, area, 1e-13);
        EXPECT_EQ(euler_characteristic(mesh), 1);
        for (const Face& f : mesh.faces) {
            const Vec3 &a = mesh.positions[f[0]], &b = mesh.positions[f[1]], &c = mesh.positions[f[2]];
            EXPECT_GT((b - a).cross(c - a).z(), 0);
        }
    }
    EXPECT_NEAR(surface(shapes::disk(20).faces, shapes::disk(20).positions).area, std::acos(-1.0), 0.01);
}

TEST(Shapes, TorusCylinderFanTopology) {
    expect_closed_oriented(shapes::torus(9, 5));
    EXPECT_EQ(euler_characteristic(shapes::torus(9, 5)), 0);
    EXPECT_GT(surface(shapes::torus(9, 5).faces, shapes::torus(9, 5).positions).volume, 0);
    EXPECT_EQ(euler_characteristic(shapes::open_cylinder(8, 3)), 0);
    EXPECT_EQ(count(vertex_rings(shapes::open_cylinder(8, 3)), RingKind::open), 16);
    EXPECT_EQ(vertex_rings(shapes::fan(12)).size(0), 12);
}

TEST(Shapes, BlockHasItsVolumeFlatFacesAndCreases) {
    const Mesh mesh = shapes::block(20);
    expect_closed_oriented(mesh);
    EXPECT_EQ(euler_characteristic(mesh), 2);
    // Cross-section: 3 by 1, less the groove's circle segment (chord 0.8, tangents at 45 degrees), ramp and step.
    const double radius = 0.4 * std::sqrt(2.0), segment = radius * radius * (std::acos(-1.0) / 4 - 0.5);
    EXPECT_NEAR(surface(mesh.faces, mesh.positions).volume, 2 * (3 - segment - 0.15 - 0.3), 1e-2);
    Rings rings = vertex_rings(mesh);
    EXPECT_EQ(count(rings, RingKind::closed), static_cast<Index>(mesh.positions.size()));
    mark_features_by_angle(rings, mesh.positions, 30);
    // Along the creases every vertex has two feature spokes; the corners have three or more.
    Index creases = 0, corners = 0, ends = 0;
    for (Index r = 0; r < rings.rows(); ++r) {
        const auto features =
            std::count(rings.feature.begin() + rings.offset[r], rings.feature.begin() + rings.offset[r + 1], 1);
        creases += features == 2;
        corners += features > 2;
        ends += features == 1;
    }
    EXPECT_EQ(corners, 8 + 8);
    EXPECT_EQ(ends, 0);
    EXPECT_GT(creases, 12 * 20);
}

TEST(Shapes, BandedSphereIsTheSumOfItsBands) {
    const shapes::BandedSphere s = shapes::banded_sphere();
    EXPECT_NEAR(rms(s.low), 0.05, 1e-15);
    EXPECT_NEAR(rms(s.high), 0.004, 1e-15);
    EXPECT_LT(std::abs(mean(s.low, s.high)), 0.02 * 0.05 * 0.004);
    for (std::size_t v = 0; v < s.sphere.size(); ++v) {
        EXPECT_LT((s.mesh.positions[v] - (1 + s.low[v] + s.high[v]) * s.sphere[v]).norm(), 1e-15);
    }
}

TEST(Shapes, HarmonicHasItsDegreeOnly) {
    // Over a fine uniform sphere the harmonic of degree l is orthogonal to all powers of (d . x) below l, and its
    // integral against a zonal harmonic of its own degree reproduces it (Funk-Hecke): 4 pi / (2 l + 1) h(d).
    const Mesh mesh = shapes::icosphere(60);
    const Rings rings = vertex_rings(mesh);
    std::vector<double> area(mesh.positions.size(), 0);
    for (const Face& f : mesh.faces) {
        const Vec3 &a = mesh.positions[f[0]], &b = mesh.positions[f[1]], &c = mesh.positions[f[2]];
        for (const Index v : f) area[v] += (b - a).cross(c - a).norm() / 6;
    }
    const Index degree = 7;
    const std::vector<double> h = shapes::harmonic(mesh.positions, degree, 5);
    EXPECT_NEAR(rms(h), 1, 1e-14);
    for (Index power = 0; power < degree; ++power) {
        double sum = 0;
        for (std::size_t v = 0; v < h.size(); ++v) sum += area[v] * h[v] * std::pow(mesh.positions[v].z(), power);
        EXPECT_NEAR(sum, 0, 2e-2) << power;
    }
    for (const std::size_t at : {0, 100, 20000}) {
        double sum = 0;
        for (std::size_t v = 0; v < h.size(); ++v) {
            sum += area[v] * h[v] * std::legendre(degree, mesh.positions[at].dot(mesh.positions[v]));
        }
        EXPECT_NEAR(sum, 4 * std::acos(-1.0) / (2 * degree + 1) * h[at], 1e-2);
    }
}

TEST(Shapes, TerrainCarriesData) {
    const shapes::Terrain t = shapes::terrain(32);
    const std::size_t n = t.mesh.positions.size();
    ASSERT_EQ(t.color.size(), 4 * n);
    ASSERT_EQ(t.texcoord.size(), 2 * n);
    ASSERT_EQ(t.scalar.size(), n);
    for (const double c : t.color) EXPECT_TRUE(c >= 0 && c <= 255);
    const auto [low, high] = std::minmax_element(t.color.begin(), t.color.end());
    EXPECT_GT(*high - *low, 50);
}

TEST(Shapes, NastyOnesAreNastyAsNamed) {
    EXPECT_GT(count(vertex_rings(shapes::bowtie()), RingKind::irregular), 0);
    EXPECT_EQ(vertex_rings(shapes::bowtie()).kind[0], RingKind::irregular);
    EXPECT_EQ(count(vertex_rings(shapes::three_faces_on_an_edge()), RingKind::irregular), 2);
    EXPECT_EQ(count(vertex_rings(shapes::double_sided_triangle()), RingKind::irregular), 3);
    EXPECT_EQ(count(vertex_rings(shapes::unreferenced_vertices()), RingKind::isolated), 3);
    EXPECT_GT(count(vertex_rings(shapes::duplicate_faces()), RingKind::irregular), 0);
    const Mesh soup = shapes::duplicate_vertices();
    EXPECT_EQ(count(vertex_rings(soup), RingKind::open), static_cast<Index>(soup.positions.size()));
    const Rings valences = vertex_rings(shapes::valence_three());
    for (Index r = 0; r < 4; ++r) EXPECT_EQ(valences.size(r), 6);
    for (Index r = 4; r < 8; ++r) EXPECT_EQ(valences.size(r), 3);
    const Mesh reversed = shapes::inconsistent_orientation();
    EXPECT_EQ(count(vertex_rings(reversed), RingKind::closed), static_cast<Index>(reversed.positions.size()));
    EXPECT_TRUE(std::isnan(shapes::not_finite(std::nan("")).positions[5].y()));
}

TEST(Shapes, MoebiusBandIsOneSidedWithOneBoundary) {
    const Mesh mesh = shapes::moebius_band(12, 3);
    EXPECT_EQ(euler_characteristic(mesh), 0);
    const Rings rings = vertex_rings(mesh);
    EXPECT_EQ(count(rings, RingKind::open), 2 * 12);
    EXPECT_EQ(count(rings, RingKind::closed), 2 * 12);
    // Walking along the boundary from vertex 0 meets all boundary vertices: there is one boundary, not two.
    Index at = 0, before = -1, steps = 0;
    do {
        const Index a = *rings.begin(at), b = *(rings.begin(at) + rings.size(at) - 1), next = a == before ? b : a;
        before = at;
        at = next;
        ++steps;
    } while (at != 0);
    EXPECT_EQ(steps, 2 * 12);
}

TEST(Shapes, SameForSameSeedOnly) {
    const Mesh a = shapes::irregular_sphere(1000), b = shapes::irregular_sphere(1000);
    const Mesh c = shapes::irregular_sphere(1000, {0.3, 0.3, 2});
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.faces, b.faces);
    EXPECT_NE(a.positions, c.positions);
    EXPECT_NE(a.faces, c.faces);
}

TEST(Shapes, EveryClassIsFiniteSmallAndNamedOnce) {
    std::set<std::string> names;
    for (const auto& [name, mesh] : shapes::every_class()) {
        EXPECT_TRUE(names.insert(name).second) << name;
        EXPECT_LE(mesh.positions.size(), 4000u) << name;
        for (const Vec3& p : mesh.positions) EXPECT_TRUE(p.allFinite()) << name;
        for (const Face& f : mesh.faces) {
            for (const Index v : f) EXPECT_TRUE(v >= 0 && v < static_cast<Index>(mesh.positions.size())) << name;
        }
    }
}

}  // namespace multires
