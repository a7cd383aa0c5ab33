#include "measure/distance.h"

#include "fixtures.h"
#include "measure/measure.h"

#include <cmath>

using namespace multires;

namespace {

/// Closest point of a triangle by brute force over a fine grid, then refined on it: an upper bound of the distance.
double sampled_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    double best = 1e300;
    constexpr int n = 200;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
            const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
            best = std::min(best, ((1 - u - v) * a + u * b + v * c - p).norm());
        }
    return best;
}

double brute_force(const Vec3& p, const Mesh& mesh) {
    double best = 1e300;
    for (const Face& f : mesh.faces)
        best = std::min(
            best,
            (closest_on_triangle(p, mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]]) - p).norm());
    return best;
}

}  // namespace

TEST(Distance, ClosestPointOfATriangleIsTheClosest) {
    shapes::Random random(3);
    for (int i = 0; i < 60; ++i) {
        const Vec3 a = random.direction(), b = random.direction(), p = 2 * random.direction();
        const Vec3 c = i % 4 == 0 ? a : i % 4 == 1 ? Vec3(0.3 * a + 0.7 * b) : random.direction();
        const Vec3 q = closest_on_triangle(p, a, b, c);
        const double exact = (q - p).norm(), sampled = sampled_distance(p, a, b, c);
        EXPECT_LE(exact, sampled + 1e-12);
        EXPECT_GE(exact, sampled - 0.03);
        EXPECT_LE(sampled_distance(q, a, b, c), 0.03) << "not on the triangle";
    }
}

TEST(Distance, TreeFindsWhatBruteForceFindsOnEveryClass) {
    shapes::Random random(5);
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        const SurfaceTree tree(mesh.faces, mesh.positions);
        const Box box = bounding_box(mesh.positions);
        for (int i = 0; i < 50; ++i) {
            const Vec3 p = box.center() + random.uniform(0, 1.5) * box.diagonal() * random.direction();
            const Index hint = i % 2 ? -1 : static_cast<Index>(random.bits() % mesh.faces.size());
            const SurfaceTree::Hit hit = tree.closest(p, hint);
            ASSERT_NEAR(std::sqrt(hit.squared), brute_force(p, mesh), 1e-12 * box.diagonal());
            const Face& f = mesh.faces[hit.face];
            const Vec3 q = closest_on_triangle(p, mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]]);
            ASSERT_EQ(q, hit.point);
        }
    }
}

TEST(Distance, SampleWeightsSumToTheArea) {
    for (const auto& [name, mesh] : fixtures::every_class())
        for (const double spacing : {0.0, 0.05, 1.0}) {
            const SurfaceSamples s = sample_surface(mesh.faces, mesh.positions, spacing);
            double sum = 0;
            for (const double w : s.weights) sum += w;
            EXPECT_NEAR(sum, surface(mesh.faces, mesh.positions).area, 1e-10 * (1 + sum)) << name;
        }
}

TEST(Distance, SamplesIntegrateQuadraticFunctions) {
    const Mesh mesh{{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}, {{0, 1, 2}}};
    const SurfaceSamples s = sample_surface(mesh.faces, mesh.positions, 0);
    double sum = 0;
    for (std::size_t i = 0; i < s.points.size(); ++i) sum += s.weights[i] * s.points[i].x() * s.points[i].x();
    EXPECT_NEAR(sum, 2 * 2 * 2 * 3 / 12.0, 1e-12);  // b^3 h / 12
}

TEST(Distance, ParallelPlanesAreTheirDistanceApart) {
    const Mesh a = shapes::plane(10), b = shapes::plane(7, {0.2, 0.4, 9});
    Mesh raised = b;
    for (Vec3& p : raised.positions) p.z() += 0.25;
    const Distance d = two_sided_distance(a.faces, a.positions, raised.faces, raised.positions);
    EXPECT_NEAR(d.largest, 0.25, 1e-12);
    EXPECT_NEAR(d.rms, 0.25, 1e-12);
}

TEST(Distance, IsTheSameForAnyNumberOfThreadsAndSymmetric) {
    const Mesh a = shapes::scan(3000), b = shapes::irregular_sphere(500);
    const auto distance = [&](int threads) {
        const fixtures::Threads scope(threads);
        return two_sided_distance(a.faces, a.positions, b.faces, b.positions);
    };
    const Distance one = distance(1), four = distance(4);
    EXPECT_EQ(one.rms, four.rms);
    EXPECT_EQ(one.largest, four.largest);
    const Distance back = two_sided_distance(b.faces, b.positions, a.faces, a.positions);
    EXPECT_EQ(back.largest, one.largest);
    EXPECT_NEAR(back.rms, one.rms, 1e-15);
    EXPECT_LT(two_sided_distance(a.faces, a.positions, a.faces, a.positions).largest, 1e-15);
}
