#include "denoise/weak_impulses.h"

#include "denoise/crease_fit.h"
#include "denoise_fixtures.h"
#include "measure/vertex_normals.h"

namespace multires {

using namespace fixtures;

namespace {

/// @param[out] beside_creases  after that, unless there are none
Positions set_back(const Mesh& mesh, Positions* beside_creases = nullptr) {
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()));
    const Neighbours near = neighbours(mesh.faces, at);
    double highest = 0;
    const Positions after = without_weak_impulses(mesh.faces, mesh.positions, at, near, highest);
    if (beside_creases && highest > 0)
        *beside_creases = without_impulses_beside_creases(mesh.faces, after, at, near, highest);
    return after;
}

double rms_distance(const Positions& a, const Positions& b) { return displacement(a, b).rms; }

/// Some vertices moved along the normals.
/// @param share   of the vertices
/// @param height  of one that is moved, mean edge lengths
template <class Height>
Mesh with_some_moved(Mesh mesh, double share, const Height& height) {
    const Positions normal = fixtures::vertex_normals(mesh);
    const double edge = mean_edge_length(mesh.faces, mesh.positions);
    shapes::Random random(7);
    for (std::size_t v = 0; v < normal.size(); ++v)
        if (random.uniform() < share) mesh.positions[v] += height(random) * edge * normal[v];
    return mesh;
}

}  // namespace

TEST(WeakImpulses, AreSetBackWhereTheSurfaceBends) {
    for (const Mesh& truth : {shapes::irregular_sphere(2000), shapes::irregular_sphere(6000)})
        for (const double share : {0.05, 1.0 / 7})
            for (const double size : {0.05, 0.2}) {
                SCOPED_TRACE(size);
                const Mesh mesh =
                    with_some_moved(truth, share, [&](shapes::Random& random) { return size * gaussian(random); });
                EXPECT_LT(rms_distance(truth.positions, set_back(mesh)),
                          0.5 * rms_distance(truth.positions, mesh.positions));
                EXPECT_LT(mean_normal_angle(truth.faces, truth.positions, denoised(mesh)),
                          0.4 * mean_normal_angle(truth.faces, truth.positions, mesh.positions));
            }
}

TEST(WeakImpulses, AreSetBackBesideCreases) {
    const Mesh truth = shapes::block(16);
    for (const double size : {0.05, 0.2}) {
        SCOPED_TRACE(size);
        const Mesh mesh = with_some_moved(truth, 0.1, [&](shapes::Random& random) { return size * gaussian(random); });
        Positions after = mesh.positions;
        const Positions before = set_back(mesh, &after);
        EXPECT_LT(rms_distance(truth.positions, after), 0.95 * rms_distance(truth.positions, before));
        for (std::size_t v = 0; v < after.size(); ++v)
            EXPECT_TRUE(mesh.positions[v] != truth.positions[v] || (after[v] - before[v]).norm() < 1e-9);
    }
}

TEST(WeakImpulses, AreSetBackOnCreases) {
    const Mesh truth = shapes::block(16);
    const Incidence at = vertex_faces(truth.faces, static_cast<Index>(truth.positions.size()));
    const Neighbours near = neighbours(truth.faces, at);
    int nearer = 0, wrong = 0;
    for (Index v = 0; v < near.rows(); ++v) {
        EXPECT_EQ(to_crease(truth.faces, truth.positions, at, near, v), Vec3(0, 0, 0));
        Positions p = truth.positions;
        Vec3 normal = Vec3::Zero();
        for (const Index f : at[v]) normal += area_vector(truth.faces[f], p).normalized();
        p[v] += 0.1 * (p[near.vertex[near.offset[v]]] - p[v]).norm() * normal.normalized();
        const Vec3 move = to_crease(truth.faces, p, at, near, v);
        if (move.squaredNorm() == 0) continue;
        const bool well = (p[v] + move - truth.positions[v]).norm() < 0.3 * (p[v] - truth.positions[v]).norm();
        ++(well ? nearer : wrong);
    }
    EXPECT_GT(nearer, 50);
    EXPECT_LE(20 * wrong, nearer);
}

TEST(WeakImpulses, ShapesAndGaussianNoiseHaveNone) {
    for (const Mesh& shape :
         {shapes::plane(40), shapes::irregular_sphere(3000), shapes::block(10), shapes::scan(3000), rough_terrain(40)})
        for (const double noise : {0.0, 0.05, 0.3}) {
            Mesh mesh = shape;
            mesh.positions = with_noise(shape, noise);
            EXPECT_EQ(set_back(mesh), mesh.positions);
        }
    for (const auto& [name, mesh] : every_class()) {
        SCOPED_TRACE(name);
        for (const Vec3& p : set_back(mesh)) EXPECT_TRUE(p.allFinite());
    }
}

TEST(WeakImpulses, ThatAllGoToOneSideAreShape) {
    const Mesh studs = with_some_moved(shapes::irregular_sphere(4000), 0.1,
                                       [](shapes::Random& random) { return 0.1 + 0.1 * random.uniform(); });
    EXPECT_EQ(set_back(studs), studs.positions);
}

TEST(WeakImpulses, AreNotHigherThanWhereTheSurfaceIsQuiet) {
    // Impulses everywhere, on one half waves that are not as quiet, and studs on these.
    const Mesh sphere = shapes::irregular_sphere(6000);
    const auto is_quiet = [&](std::size_t v) { return sphere.positions[v].z() > 0; };
    const Positions normal = fixtures::vertex_normals(sphere);
    const double edge = mean_edge_length(sphere.faces, sphere.positions);
    Mesh mesh = with_some_moved(sphere, 0.1, [](shapes::Random& random) {
        return (random.uniform() < 0.5 ? -1 : 1) * (0.06 + 0.02 * random.uniform());
    });
    shapes::Random random(3);
    std::vector<std::size_t> studs;
    for (std::size_t v = 0; v < normal.size(); ++v) {
        if (is_quiet(v)) continue;
        mesh.positions[v] += 0.005 * edge * gaussian(random) * normal[v];
        if (random.uniform() > 0.02) continue;
        studs.push_back(v);
        mesh.positions[v] = sphere.positions[v] + 0.2 * edge * normal[v];
    }
    const Positions after = set_back(mesh);
    EXPECT_LT(rms_distance(sphere.positions, after), rms_distance(sphere.positions, mesh.positions));
    for (const std::size_t v : studs) EXPECT_EQ(after[v], mesh.positions[v]) << v;
}

TEST(WeakImpulses, AreTheSameBitsForAnyNumberOfThreads) {
    const Mesh mesh = with_some_moved(shapes::irregular_sphere(4000), 0.1,
                                      [](shapes::Random& random) { return 0.1 * gaussian(random); });
    Positions first;
    for (const int threads : {1, 3}) {
        const Threads scope(threads);
        const Positions p = set_back(mesh);
        if (threads == 1)
            first = p;
        else
            EXPECT_EQ(p, first);
    }
    EXPECT_NE(first, mesh.positions);
}

}  // namespace multires
