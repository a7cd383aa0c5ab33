#include "measure/measure.h"

#include "random.h"
#include "shapes.h"

#include "base/parallel.h"
#include <gtest/gtest.h>

#include <cmath>

namespace multires {
namespace {

Positions shaken(const Positions& positions, double amount) {
    shapes::Random random(7);
    Positions result(positions);
    for (Vec3& p : result) p += amount * random.uniform() * random.direction();
    return result;
}

}  // namespace

TEST(Measure, TetrahedronHasKnownSizes) {
    const Mesh mesh = shapes::tetrahedron();  // edge 2 sqrt 2
    const Surface s = surface(mesh.faces, mesh.positions);
    EXPECT_NEAR(s.area, 8 * std::sqrt(3.0), 1e-14);
    EXPECT_NEAR(s.volume, 8.0 / 3, 1e-14);
    EXPECT_LT(s.centroid.norm(), 1e-15);
    EXPECT_DOUBLE_EQ(mean_edge_length(mesh.faces, mesh.positions), std::sqrt(8.0));
    EXPECT_DOUBLE_EQ(bounding_box(mesh.positions).diagonal(), std::sqrt(12.0));
    EXPECT_NEAR(triangle_quality(mesh.faces, mesh.positions).mean, 1, 1e-15);
    EXPECT_NEAR(triangle_quality(mesh.faces, mesh.positions).least, 1, 1e-15);
}

TEST(Measure, CentroidIsThatOfTheArea) {
    // A square with a finely divided left half: the mean of the vertices would lie left of the middle.
    Mesh mesh = shapes::plane(16);
    for (Vec3& p : mesh.positions) p.x() *= p.x();
    EXPECT_LT((surface(mesh.faces, mesh.positions).centroid - Vec3(0.5, 0.5, 0)).norm(), 1e-14);
    EXPECT_NEAR(surface(mesh.faces, mesh.positions).area, 1, 1e-14);
}

TEST(Measure, SphereConvergesToFourPi) {
    const Mesh mesh = shapes::icosphere(100);
    const Surface s = surface(mesh.faces, mesh.positions);
    EXPECT_NEAR(s.area, 4 * pi, 4 * pi * 1e-3);
    EXPECT_LT(s.area, 4 * pi);
    EXPECT_NEAR(s.volume, 4 * pi / 3, 4 * pi / 3 * 1e-3);
}

TEST(Measure, VolumeOfClosedMeshDoesNotDependOnPlaceOrApex) {
    Mesh mesh = shapes::block(8);
    const double volume = surface(mesh.faces, mesh.positions).volume;
    EXPECT_NEAR(surface(mesh.faces, mesh.positions, Vec3(-10, 3, 5)).volume, volume, 1e-11);
    for (Vec3& p : mesh.positions) p += Vec3(1e6, -1e6, 2e6);
    EXPECT_NEAR(surface(mesh.faces, mesh.positions).volume, volume, 1e-8);
    for (Face& f : mesh.faces) std::swap(f[0], f[1]);
    EXPECT_NEAR(surface(mesh.faces, mesh.positions).volume, -volume, 1e-8);
}

namespace {

/// Area by Heron's formula, volume by determinants and centroid by the mean of the corners, summed plainly.
Surface surface_by_definition(const Faces& faces, const Positions& p, const Vec3& apex) {
    Surface s;
    for (const Face& f : faces) {
        const double a = (p[f[0]] - p[f[1]]).norm(), b = (p[f[1]] - p[f[2]]).norm(), c = (p[f[2]] - p[f[0]]).norm();
        const double h = (a + b + c) / 2, area = std::sqrt(std::max(0.0, h * (h - a) * (h - b) * (h - c)));
        Eigen::Matrix3d tetrahedron;
        tetrahedron << p[f[0]] - apex, p[f[1]] - apex, p[f[2]] - apex;
        s.area += area;
        s.volume += tetrahedron.determinant() / 6;
        s.centroid += area * (p[f[0]] + p[f[1]] + p[f[2]]) / 3;
    }
    if (s.area > 0) s.centroid /= s.area;
    return s;
}

void expect_surface(const Surface& found, const Surface& expected) {
    // Heron's formula loses half of the digits on slivers.
    EXPECT_NEAR(found.area, expected.area, 1e-7 * expected.area);
    EXPECT_NEAR(found.volume, expected.volume, 1e-11);
    EXPECT_LT((found.centroid - expected.centroid).norm(), 1e-6);
}

}  // namespace

TEST(Measure, CompareGivesAreaVolumeCentroidDisplacementAndFlipsByTheirDefinitions) {
    for (const auto& [name, mesh] : shapes::every_class()) {
        SCOPED_TRACE(name);
        const Positions after = shaken(mesh.positions, 0.2);
        const Change change = compare(mesh.faces, mesh.positions, after);
        Vec3 low = mesh.positions[0], high = low;
        double largest = 0, squares = 0;
        for (std::size_t v = 0; v < after.size(); ++v) {
            low = low.cwiseMin(mesh.positions[v]), high = high.cwiseMax(mesh.positions[v]);
            const double moved = (after[v] - mesh.positions[v]).norm();
            largest = std::max(largest, moved), squares += moved * moved;
        }
        expect_surface(change.before, surface_by_definition(mesh.faces, mesh.positions, (low + high) / 2));
        expect_surface(change.after, surface_by_definition(mesh.faces, after, (low + high) / 2));
        EXPECT_NEAR(change.displacement.largest, largest, 1e-15);
        EXPECT_NEAR(change.displacement.rms, std::sqrt(squares / static_cast<double>(after.size())), 1e-15);
        Index flipped = 0;
        const auto normal_before = face_normals(mesh.faces, mesh.positions),
                   normal_after = face_normals(mesh.faces, after);
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) flipped += normal_before[f].dot(normal_after[f]) < 0;
        EXPECT_EQ(change.flipped_faces, flipped) << name;
    }
}

TEST(Measure, FlipsCountTurnsButNoDegenerateFaces) {
    const Mesh mesh = shapes::plane(4, {0, 0, 1});
    Positions after(mesh.positions);
    for (Vec3& p : after) p.x() = -p.x();
    EXPECT_EQ(compare(mesh.faces, mesh.positions, after).flipped_faces, 32);
    EXPECT_EQ(compare(mesh.faces, mesh.positions, mesh.positions).flipped_faces, 0);
    const Positions line{{0, 0, 0}, {1, 0, 0}, {2, 1e-12, 0}}, back{{0, 0, 0}, {1, 0, 0}, {2, -1, 0}};
    EXPECT_EQ(compare({{0, 1, 2}}, line, back).flipped_faces, 0);
    EXPECT_EQ(compare({{0, 1, 2}}, {{0, 0, 0}, {1, 0, 0}, {2, 1e-8, 0}}, back).flipped_faces, 1);
}

TEST(Measure, DisplacementIsLargestAndRms) {
    const Positions before(4, Vec3(1, 1, 1)), after{{1, 1, 1}, {1, 1, 4}, {1, 5, 1}, {1, 1, 1}};
    EXPECT_DOUBLE_EQ(displacement(before, after).largest, 4);
    EXPECT_DOUBLE_EQ(displacement(before, after).rms, 2.5);
    EXPECT_DOUBLE_EQ(rms({3, 4, 0, 0}), 2.5);
}

TEST(Measure, NormalAngleIsTheTurn) {
    const Mesh mesh = shapes::plane(8);
    for (const double degrees : {0.0, 1e-6, 30.0, 90.0, 179.0}) {
        Positions turned(mesh.positions);
        for (Vec3& p : turned) p = Eigen::AngleAxisd(degrees * pi / 180, Vec3::UnitX()) * p;
        EXPECT_NEAR(mean_normal_angle(mesh.faces, mesh.positions, turned), degrees, 1e-12);
    }
    Faces faces(mesh.faces);
    faces.push_back({0, 0, 1});
    Positions turned(mesh.positions);
    for (Vec3& p : turned) p = Eigen::AngleAxisd(pi / 6, Vec3::UnitX()) * p;
    EXPECT_NEAR(mean_normal_angle(faces, mesh.positions, turned), 30, 1e-12);
}

TEST(Measure, NormalsOfDegenerateFacesAreZero) {
    const Mesh mesh = shapes::collinear_faces();  // coordinates are multiples of 1/16: areas are exact
    const Array<Vec3> normals = face_normals(mesh.faces, mesh.positions);
    int zero = 0;
    for (std::size_t f = 0; f < normals.size(); ++f) {
        const Vec3 &a = mesh.positions[mesh.faces[f][0]], &b = mesh.positions[mesh.faces[f][1]],
                   &c = mesh.positions[mesh.faces[f][2]];
        const double area2 = (b - a).cross(c - a).z();
        EXPECT_EQ(normals[f], Vec3(0, 0, area2 > 0 ? 1 : (area2 < 0 ? -1 : 0)));
        zero += area2 == 0;
    }
    EXPECT_GE(zero, 4);
    EXPECT_EQ(triangle_quality(mesh.faces, mesh.positions).least, 0);
}

TEST(Measure, SameForOneAndTwoThreads) {
    const Mesh mesh = shapes::scan(20000);
    const Positions after = shaken(mesh.positions, 0.01);
    set_thread_count(1);
    const Change one = compare(mesh.faces, mesh.positions, after);
    const double angle = mean_normal_angle(mesh.faces, mesh.positions, after);
    set_thread_count(2);
    const Change two = compare(mesh.faces, mesh.positions, after);
    EXPECT_EQ(one.after.volume, two.after.volume);
    EXPECT_EQ(one.after.area, two.after.area);
    EXPECT_EQ(one.after.centroid, two.after.centroid);
    EXPECT_EQ(one.displacement.rms, two.displacement.rms);
    EXPECT_EQ(angle, mean_normal_angle(mesh.faces, mesh.positions, after));
    set_thread_count(0);
}

TEST(Measure, NothingMeasuresZero) {
    EXPECT_EQ(bounding_box({}).diagonal(), 0);
    EXPECT_EQ(mean_edge_length({}, {}), 0);
    EXPECT_EQ(rms({}), 0);
    const Change change = compare({}, {}, {});
    EXPECT_EQ(change.before.area, 0);
    EXPECT_EQ(change.displacement.rms, 0);
    EXPECT_EQ(mean_normal_angle({}, {}, {}), 0);
}

}  // namespace multires
