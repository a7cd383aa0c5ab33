#include "editing/phong.h"

#include "filter_fixtures.h"
#include "measure/distance.h"
#include "measure/measure.h"
#include "random.h"

#include <Eigen/Dense>

// Base points and heights along a Phong field of normals.

namespace multires {
namespace {

/// Points up to some height over and under random places of a surface.
Positions points_near(const Mesh& mesh, double height, int count) {
    shapes::Random random(11);
    Positions points;
    for (int i = 0; i < count; ++i) {
        const Face& f = mesh.faces[random.bits() % mesh.faces.size()];
        double a = random.uniform(0, 1), b = random.uniform(0, 1);
        if (a + b > 1) a = 1 - a, b = 1 - b;
        const Vec3 q = a * mesh.positions[f[0]] + b * mesh.positions[f[1]] + (1 - a - b) * mesh.positions[f[2]];
        points.push_back(q + random.uniform(0, height) * random.direction());
    }
    return points;
}

double sine(const PhongSurface& surface, const BasePoint& b, const Vec3& p) {
    const Vec3 d = p - surface.base(b.face, b.weight), n = surface.normal(b.face, b.weight);
    return d.norm() > 0 ? d.cross(n).norm() / (d.norm() * n.norm()) : 0;
}

/// The distance of p from the nearest point of the surface whose normal goes through it, by trying places of every face
/// on ever finer grids.
double nearest_by_force(const PhongSurface& surface, const Vec3& p) {
    double nearest = std::numeric_limits<double>::infinity();
    for (Index f = 0; f < static_cast<Index>(surface.faces().size()); ++f) {
        Vec3 best(1.0 / 3, 1.0 / 3, 1.0 / 3);
        const auto off = [&](const Vec3& w) { return (p - surface.base(f, w)).cross(surface.normal(f, w)).norm(); };
        for (double width = 1; width > 1e-7; width /= 3) {
            const Vec3 centre = best;
            for (int i = -6; i <= 6; ++i)
                for (int j = -6; j <= 6; ++j) {
                    const Vec3 w = centre + width / 6 * Vec3(i, j, -i - j);
                    if (w.minCoeff() >= 0 && off(w) < off(best)) best = w;
                }
        }
        if (off(best) < 1e-5 * (p - surface.base(f, best)).norm() + 1e-6)
            nearest = std::min(nearest, (p - surface.base(f, best)).norm());
    }
    return nearest;
}

}  // namespace

TEST(PhongRoot, FindsThePlaceThatAPointWasLiftedFrom) {
    shapes::Random random(5);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 up = random.direction(), across = up.unitOrthogonal(), along = up.cross(across);
        const Vec3 at[3] = {across, Vec3(-0.4 * across + along), Vec3(-0.5 * across - 0.8 * along)};
        Vec3 normal[3], corner[3];
        for (Vec3& n : normal) n = (up + 0.3 * random.direction()).normalized();
        const double a = random.uniform(0, 1), b = random.uniform(0, 1 - a);
        const Vec3 w(a, b, 1 - a - b), n = w[0] * normal[0] + w[1] * normal[1] + w[2] * normal[2];
        const Vec3 p = w[0] * at[0] + w[1] * at[1] + w[2] * at[2] + random.uniform(-0.5, 0.5) * n;
        for (int k = 0; k < 3; ++k) corner[k] = at[k] - p;
        Vec3 found;
        ASSERT_TRUE(phong_root(corner, normal, found));
        EXPECT_LT((found - w).norm(), 1e-11);
    }
}

TEST(BasePoints, AreThoseThatAreFoundByForce) {
    const Mesh mesh = shapes::scan(150, {0.2, 0.3, 5});
    const PhongSurface surface(mesh.faces, mesh.positions);
    const Positions points = points_near(mesh, 0.15, 25);
    const BasePoints found = base_points(surface, points, {}, {});
    EXPECT_EQ(found.border, 0);
    int same = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double force = nearest_by_force(surface, points[i]);
        const BasePoint& b = found.points[i];
        ASSERT_EQ(b.kind, BaseKind::inside) << "by force: " << force;
        EXPECT_LT(sine(surface, b, points[i]), 1e-9);
        EXPECT_GT(std::abs(b.detail[2]), force - 1e-4);
        same += std::abs(b.detail[2]) < force + 1e-4;
    }
    EXPECT_GE(same, 24);  // the walk ends at the first it meets
}

TEST(BasePoints, GiveThePointsBackOnEveryClassOfMesh) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        const double size = bounding_box(mesh.positions).diagonal();
        const PhongSurface surface(mesh.faces, mesh.positions);
        const Array<Index> starts = faces_to_start_from(mesh.faces, mesh.positions.size());
        Positions points = points_near(mesh, 0.1 * size, static_cast<int>(mesh.positions.size()));
        for (const Array<Index>& from : {starts, Array<Index>()}) {
            const BasePoints found = base_points(surface, points, from, {});
            Index border = 0, nearest = 0;
            for (std::size_t i = 0; i < points.size(); ++i) {
                const BasePoint& b = found.points[i];
                EXPECT_LT((surface.place(b) - points[i]).norm(), 1e-12 * size);
                EXPECT_NEAR(b.weight.sum(), 1, 1e-14);
                EXPECT_GE(b.weight.minCoeff(), 0);
                if (b.kind == BaseKind::inside) {
                    EXPECT_LT(b.detail.head<2>().norm(), 1e-8 * size);
                }
                border += b.kind == BaseKind::border, nearest += b.kind == BaseKind::nearest;
            }
            EXPECT_EQ(border, found.border);
            EXPECT_EQ(nearest, found.nearest);
        }
    }
}

TEST(BasePoints, BeyondTheBoundaryAreOnItsEdges) {
    const Mesh grid = shapes::plane(8, {0.2, 0, 1});
    const PhongSurface surface(grid.faces, grid.positions);
    const Positions points = {{-0.2, 0.4, 0.1}, {1.3, 0.7, 0}, {0.5, 0.5, 0.2}, {1.1, 1.2, -0.1}};
    const BasePoints found = base_points(surface, points, {}, {});
    EXPECT_EQ(found.border, 3);
    EXPECT_EQ(found.nearest, 0);
    EXPECT_LT((surface.base(found.points[0].face, found.points[0].weight) - Vec3(0, 0.4, 0)).norm(), 1e-12);
    EXPECT_EQ(found.points[2].kind, BaseKind::inside);
    EXPECT_NEAR(found.points[2].detail[2], 0.2, 1e-12);
}

TEST(BasePoints, OfVerticesOfTheSurfaceAreThemselves) {
    const Mesh mesh = shapes::scan(2000, {0.2, 0.3, 5});
    const PhongSurface surface(mesh.faces, mesh.positions);
    const BasePoints found =
        base_points(surface, mesh.positions, faces_to_start_from(mesh.faces, mesh.positions.size()), {});
    EXPECT_EQ(found.nearest + found.border, 0);
    for (const BasePoint& b : found.points) EXPECT_LT(b.detail.norm(), 1e-14);
}

TEST(BasePoints, MoveWithTheSurface) {
    const Mesh mesh = shapes::scan(500, {0.2, 0.3, 5});
    const fixtures::Motion motion;
    const Mesh moved = motion(mesh);
    const PhongSurface before(mesh.faces, mesh.positions), after(moved.faces, moved.positions);
    const Positions points = points_near(mesh, 0.3, 500);
    const BasePoints found = base_points(before, points, {}, {});
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_LT((after.place(found.points[i]) - motion(points[i])).norm(), 1e-13);
}

TEST(BasePoints, DoNotDependOnTheNumberOfThreads) {
    const Mesh mesh = shapes::scan(3000, {0.2, 0.3, 5});
    const PhongSurface surface(mesh.faces, mesh.positions);
    const Positions points = points_near(mesh, 0.4, 3000);
    Positions first;
    for (const int threads : {1, 2, 5}) {
        const fixtures::Threads scope(threads);
        Positions details;
        for (const BasePoint& b : base_points(surface, points, {}, {}).points) details.push_back(b.detail);
        if (first.empty()) first = details;
        EXPECT_EQ(details, first);
    }
}

}  // namespace multires
