#include "denoise/lattice.h"

#include "measure/measure.h"

#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

Positions rounded(Positions p, double step, const Vec3& origin) {
    for (Vec3& v : p)
        for (int k = 0; k < 3; ++k) v[k] = origin[k] + std::round((v[k] - origin[k]) / step) * step;
    return p;
}

}  // namespace

TEST(Lattice, StepIsFoundWhereverItsOriginIs) {
    const Positions p = shapes::irregular_sphere(2000).positions;
    for (const double step : {0.004, 0.031, 0.1})
        for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(0.3, -0.011, 7)}) {
            const auto found = lattice_step(rounded(p, step, origin), 0.001);
            ASSERT_TRUE(found) << step;
            EXPECT_NEAR(*found, step, 1e-9 * step);
        }
}

TEST(Lattice, StepIsFoundInSinglePrecision) {
    Positions p = rounded(shapes::irregular_sphere(2000).positions, 0.031, Vec3(0.3, 2, 0));
    for (Vec3& v : p) v = v.cast<float>().cast<double>();
    const auto found = lattice_step(p, 0.001);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, 0.031, 1e-6);
}

TEST(Lattice, IsNotSeenWhereThereIsNone) {
    const Positions p = shapes::irregular_sphere(2000).positions;
    EXPECT_FALSE(lattice_step(p, 0.001));
    EXPECT_FALSE(lattice_step(rounded(p, 0.004, Vec3(0, 0, 0)), 0.01)) << "finer than asked for";
    Positions one_off = rounded(p, 0.1, Vec3(0, 0, 0));
    one_off[7].y() += 0.03;
    EXPECT_FALSE(lattice_step(one_off, 0.02));
    EXPECT_FALSE(lattice_step(Positions(), 0.01));
    EXPECT_FALSE(lattice_step(Positions(5, Vec3::Zero()), 0.01));
}

TEST(Lattice, CellsHoldEachCoordinate) {
    Positions p{Vec3(1, 2, 3), Vec3(1.04, 2.2, 2.7)};
    const Positions centers{Vec3(1, 2, 3), Vec3(1, 2, 3)};
    keep_within_cells({}, centers, 0.05, p);
    EXPECT_EQ(p[0], Vec3(1, 2, 3));
    EXPECT_NEAR((p[1] - Vec3(1.04, 2.05, 2.95)).norm(), 0, 1e-12);
    keep_within_cells({{0, 0}, {0, 1U << 1 | 1U << 2}}, centers, 0.05, p);
    EXPECT_NEAR((p[1] - Vec3(1.04, 2, 3)).norm(), 0, 1e-12) << "the second stays in its planes";
}

TEST(Lattice, PlanesAlongTheAxesAndTheirCreasesAreEven) {
    const Mesh mesh = shapes::block(16);  // all planes are, but for a groove and a ramp on its top
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()));
    const double edge = mean_edge_length(mesh.faces, mesh.positions);
    for (const double step : {0.1 * edge, 0.3 * edge}) {
        const Positions p = rounded(mesh.positions, step, Vec3(0.01, 0, 0));
        const EvenPlaces even = even_places(mesh.faces, p, at, step, edge);
        for (std::size_t v = 0; v < p.size(); ++v) {
            const Vec3& q = mesh.positions[v];
            const bool bottom = q.y()<1e-9, side = q.z() < 1e-9, on_ramp = q.x()> 1.85 && q.x() < 2.35 && q.y() > 0.5;
            EXPECT_TRUE(!bottom || (even.silent[v] && (even.axes[v] & 2U))) << q;
            EXPECT_TRUE(!side || even.axes[v] & 4U) << "up to the groove: " << q;
            EXPECT_FALSE(on_ramp && even.silent[v] && q.z() > 3 * edge && q.z() < 2 - 3 * edge) << q;
        }
    }
}

TEST(Lattice, TerracesAreNotTakenForPlanes) {
    const Mesh mesh = shapes::irregular_sphere(3000);
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()));
    const double edge = mean_edge_length(mesh.faces, mesh.positions);
    for (const double step : {0.1 * edge, 0.3 * edge, 0.6 * edge}) {
        const EvenPlaces even = even_places(mesh.faces, rounded(mesh.positions, step, Vec3(0, 0, 0)), at, step, edge);
        EXPECT_TRUE(even.silent.empty() && even.axes.empty()) << step / edge;
    }
}

// Wide terraces, which go on where they do not rise upright; a ledge does not.
TEST(Lattice, SlopesAreNotTakenForPlanesLedgesAndStairsAre) {
    const Mesh flat = shapes::plane(50, {0, 0, 1});
    const Incidence at = vertex_faces(flat.faces, static_cast<Index>(flat.positions.size()));
    const double edge = (flat.positions[1] - flat.positions[0]).norm();
    const auto held = [&](double step, const auto& place) {
        Positions p = flat.positions;
        for (Vec3& v : p) v = place(v);
        p = rounded(p, step, Vec3(0, 0, 0));
        const EvenPlaces even = even_places(flat.faces, p, at, step, mean_edge_length(flat.faces, p));
        return static_cast<double>(std::count(even.axes.begin(), even.axes.end(), 4)) / static_cast<double>(p.size());
    };
    for (const double degrees : {3, 5})
        EXPECT_EQ(held(0.6 * edge, [&](Vec3 v) { return v.z() = v.x() * std::tan(degrees * 0.01745), v; }), 0);
    EXPECT_GT(held(0.6 * edge, [&](Vec3 v) { return v.z() = v.x() < 25 * edge ? 0 : 0.6 * edge, v; }), 0.9);
    EXPECT_GT(held(edge,
                   [&](const Vec3& v) {
                       const double column = std::round(v.x() / edge), stair = std::floor(column / 9);
                       return Vec3((column - stair) * edge, v.y(), stair * edge);
                   }),
              0.7);
}

}  // namespace multires
