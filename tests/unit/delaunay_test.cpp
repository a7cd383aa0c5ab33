#include "fixtures.h"
#include "solvers/delaunay.h"
#include "solvers/stiffness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

namespace multires {

using namespace fixtures;

namespace {

StiffnessOptions delaunay() {
    StiffnessOptions options;
    options.delaunay = true;
    return options;
}

double sum(const Array<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Of the angle opposite to each edge (k, k + 1).
Array<std::array<double, 3>> cotangents(const Mesh& mesh) {
    Array<std::array<double, 3>> all(mesh.faces.size());
    for (std::size_t f = 0; f < all.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const auto at = [&](int c) { return mesh.positions[mesh.faces[f][(k + c) % 3]]; };
            const Vec3 u = at(0) - at(2), v = at(1) - at(2);
            all[f][k] = u.dot(v) / u.cross(v).norm();
        }
    return all;
}

/// Two faces that share the edge (0, 1), which leaves angles of nearly 180 degrees.
Mesh kite() { return {{{0, 0, 0}, {4, 0, 0}, {2, 0.5, 0}, {2, -0.5, 0}}, {{0, 1, 2}, {1, 0, 3}}}; }

}  // namespace

TEST(Delaunay, TurnsTheEdgeOfAKite) {
    const Mesh mesh = kite();
    const IntrinsicMesh turned = intrinsic_delaunay(mesh, cotangents(mesh), {1, 1}, {});
    ASSERT_EQ(turned.changed, (Array<std::uint8_t>{1, 1}));
    for (int f = 0; f < 2; ++f)
        for (int k = 0; k < 3; ++k) {
            const Vec3 edge = mesh.positions[turned.faces[f][(k + 1) % 3]] - mesh.positions[turned.faces[f][k]];
            EXPECT_NEAR(turned.length[f][k], edge.norm(), 1e-15);
            EXPECT_FALSE(turned.faces[f][k] + turned.faces[f][(k + 1) % 3] == 1) << "the edge (0, 1) is still there";
        }
}

TEST(Delaunay, EdgesBetweenHeldVerticesAndEdgesOfFacesOfOppositeOrientationStay) {
    Mesh mesh = kite();
    EXPECT_EQ(intrinsic_delaunay(mesh, cotangents(mesh), {1, 1}, {1, 1, 0, 0}).faces, mesh.faces);
    EXPECT_NE(intrinsic_delaunay(mesh, cotangents(mesh), {1, 1}, {1, 0, 1, 1}).faces, mesh.faces);
    EXPECT_EQ(intrinsic_delaunay(mesh, cotangents(mesh), {1, 0}, {}).faces, mesh.faces);
    std::swap(mesh.faces[1][0], mesh.faces[1][1]);
    EXPECT_EQ(intrinsic_delaunay(mesh, cotangents(mesh), {1, 1}, {}).faces, mesh.faces);
}

TEST(Delaunay, WeightsOfClosedSurfacesAreNotNegative) {
    for (const auto& mesh :
         {shapes::irregular_sphere(3000, {0.4, 0.5, 3}), shapes::torus(60, 20), shapes::scan(3000)}) {
        const Stiffness c = stiffness(mesh, delaunay());
        EXPECT_GE(*std::min_element(c.weight.begin(), c.weight.end()), -1e-6);
    }
}

TEST(Delaunay, AreaStaysAndRowsStaySymmetricOnEveryMesh) {
    for (const auto& [name, mesh] : every_class()) {
        StiffnessOptions options = delaunay();
        options.spread_mass = true;
        const Stiffness c = stiffness(mesh, options);
        const double area = sum(stiffness(mesh).mass);
        EXPECT_NEAR(sum(c.mass), area, 1e-9 * area) << name;
        for (Index i = 0; i < c.rows(); ++i)
            for (Index k = c.offset[i]; k < c.offset[i + 1]; ++k) {
                const Index j = c.column[k];
                ASSERT_NE(i, j) << name;
                const auto begin = c.column.begin() + c.offset[j], end = c.column.begin() + c.offset[j + 1];
                const auto at = std::lower_bound(begin, end, i);
                ASSERT_TRUE(at != end && *at == i) << name;
                ASSERT_EQ(c.weight[k], c.weight[at - c.column.begin()]) << name;
                ASSERT_EQ(c.mass_weight[k], c.mass_weight[at - c.column.begin()]) << name;
            }
    }
}

TEST(Delaunay, LinearFunctionsOnPlanesAreHarmonic) {
    Mesh mesh = shapes::plane(30, {0.3, 0.4, 5});
    for (Vec3& p : mesh.positions) p.x() *= 5;
    const Stiffness c = stiffness(mesh, delaunay());
    Positions out(mesh.positions.size());
    apply_stiffness(c, mesh.positions[0].data(), 3, out[0].data());
    const Rings rings = vertex_rings(mesh);
    for (std::size_t i = 0; i < out.size(); ++i)
        if (rings.kind[i] == RingKind::closed) {
            EXPECT_LT(out[i].norm(), 1e-9);
        }
}

TEST(Delaunay, SameTrianglesForMovedTurnedAndScaledMeshes) {
    const Mesh mesh = shapes::irregular_sphere(2000, {0.4, 0.4, 3});
    const Stiffness here = stiffness(mesh, delaunay());
    for (const double scale : {1e-40, 1.0, 1e40}) {
        Motion motion;
        motion.scale = scale;
        motion.offset *= scale;
        const Stiffness there = stiffness(motion(mesh), delaunay());
        ASSERT_EQ(here.column, there.column);
        for (std::size_t k = 0; k < here.weight.size(); ++k) ASSERT_NEAR(here.weight[k], there.weight[k], 1e-8);
    }
}

}  // namespace multires
