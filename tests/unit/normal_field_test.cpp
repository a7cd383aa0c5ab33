#include "normals/normal_field.h"

#include "denoise_fixtures.h"

#include <set>

namespace multires {

using namespace fixtures;

namespace {

Incidence incidence_of(const Mesh& mesh) { return vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size())); }

Array<Vec3> denoised_normals(const Mesh& mesh, NormalFieldStats& stats, const NormalFieldOptions& options = {}) {
    return denoise_normals(mesh.faces, mesh.positions, face_graph(mesh.faces, incidence_of(mesh)), options, stats,
                           [](double) {});
}

Positions fitted(const Mesh& mesh, const Array<Vec3>& normals, int steps = 8) {
    return fit_vertices(mesh.faces, mesh.positions, incidence_of(mesh), normals, steps);
}

/// Mean angle between two fields of unit normals, degrees.
double mean_angle(const Array<Vec3>& a, const Array<Vec3>& b) {
    double sum = 0;
    for (std::size_t f = 0; f < a.size(); ++f) sum += std::acos(std::clamp(a[f].dot(b[f]), -1.0, 1.0));
    return sum / static_cast<double>(a.size()) * 180 / std::acos(-1.0);
}

Mesh noisy(Mesh mesh, double deviation) {
    mesh.positions = with_noise(mesh, deviation);
    return mesh;
}

}  // namespace

TEST(FaceGraph, HoldsAllFacesThatShareAVertexOrAnEdge) {
    std::vector<Mesh> meshes;
    for (const auto& named : every_class())
        if (named.second.faces.size() < 1200 && named.first != "fan") meshes.push_back(named.second);  // see below
    for (std::uint64_t seed = 0; seed < 30; ++seed) meshes.push_back(random_soup(seed));
    for (const Mesh& mesh : meshes) {
        const Incidence at = incidence_of(mesh);
        const FaceGraph graph = face_graph(mesh.faces, at);
        const Index count = static_cast<Index>(mesh.faces.size());
        ASSERT_EQ(graph.offset.size(), mesh.faces.size() + 1);
        std::set<std::pair<Index, Index>> edges;
        for (const auto& e : graph.edges) EXPECT_TRUE(e[0] < e[1] && edges.insert({e[0], e[1]}).second);
        for (Index f = 0; f < count; ++f) {
            const std::set<Index> mine(mesh.faces[f].begin(), mesh.faces[f].end());
            std::vector<Index> expected;
            for (Index g = 0; g < count; ++g) {
                const std::set<Index> other(mesh.faces[g].begin(), mesh.faces[g].end());
                const auto shared =
                    std::count_if(mine.begin(), mine.end(), [&](Index v) { return other.count(v) > 0; });
                if (g != f && shared > 0) expected.push_back(g);
                if (mine.size() == 3 && other.size() == 3 && g > f) {
                    EXPECT_EQ(edges.count({f, g}) > 0, shared >= 2);
                }
            }
            EXPECT_EQ(std::vector<Index>(graph.neighbor.begin() + graph.offset[f],
                                         graph.neighbor.begin() + graph.offset[f + 1]),
                      expected);
        }
    }
}

TEST(FaceGraph, IncidenceHoldsEveryCornerOnce) {
    for (const auto& [name, mesh] : every_class()) {
        SCOPED_TRACE(name);
        const Incidence at = incidence_of(mesh);
        ASSERT_EQ(at.items(), static_cast<Index>(3 * mesh.faces.size()));
        for (Index v = 0; v < at.size(); ++v) {
            EXPECT_TRUE(std::is_sorted(at[v].begin(), at[v].end()));
            for (const Index f : at[v])
                EXPECT_NE(std::find(mesh.faces[f].begin(), mesh.faces[f].end(), v), mesh.faces[f].end());
        }
    }
}

TEST(NormalField, FlatMeshesKeepTheirNormals) {
    const Mesh plane = shapes::plane(20);
    NormalFieldStats stats;
    EXPECT_EQ(denoised_normals(plane, stats), face_normals(plane.faces, plane.positions));
    EXPECT_EQ(stats.noise, 0);
}

TEST(NormalField, NoiseIsMeasuredAndTakenOut) {
    const Mesh plane = shapes::plane(40);
    for (const double deviation : {0.05, 0.1, 0.2}) {
        NormalFieldStats stats;
        const Mesh mesh = noisy(plane, deviation);
        const auto normals = denoised_normals(mesh, stats);
        // 1.55 times the deviation on regular triangles, 2.4 times on very irregular ones
        EXPECT_GT(stats.noise, 1.5 * deviation);
        EXPECT_LT(stats.noise, 2.5 * deviation);
        EXPECT_LT(stats.left, 0.1 * stats.noise);
        EXPECT_LT(mean_angle(normals, face_normals(plane.faces, plane.positions)),
                  0.15 * mean_angle(face_normals(mesh.faces, mesh.positions), normals));
        ASSERT_EQ(stats.share_removed.size(), 4u);
        ASSERT_EQ(stats.detail_rms.size(), 4u);
        ASSERT_EQ(stats.noise_rms.size(), 4u);
        for (const double share : stats.share_removed) EXPECT_TRUE(share >= 0 && share <= 1);
        for (std::size_t k = 1; k < 4; ++k) EXPECT_LT(stats.noise_rms[k], stats.noise_rms[k - 1]);
    }
}

TEST(NormalField, CreasesStaySharp) {
    const Mesh block = shapes::block(8);
    const auto truth = face_normals(block.faces, block.positions);
    const Mesh mesh = noisy(block, 0.1);
    NormalFieldStats stats;
    const auto normals = denoised_normals(mesh, stats);
    const FaceGraph graph = face_graph(mesh.faces, incidence_of(mesh));
    int creases = 0, kept = 0;
    for (const auto& e : graph.edges)
        if (truth[e[0]].dot(truth[e[1]]) < 0.1) {
            ++creases;
            kept += normals[e[0]].dot(normals[e[1]]) < 0.2;
        }
    EXPECT_GT(creases, 100);
    EXPECT_GE(kept, 0.97 * creases);
}

TEST(NormalField, FacesOfAFanHaveFewNeighbours) {
    for (const int sides : {64, 65, 5000}) {
        const Mesh fan = shapes::fan(sides, 0.5);
        const FaceGraph graph = face_graph(fan.faces, incidence_of(fan));
        ASSERT_EQ(fan.faces.size(), std::size_t(sides));
        EXPECT_EQ(graph.edges.size(), std::size_t(sides));
        std::set<std::array<Index, 2>> pairs;
        for (Index f = 0; f < sides; ++f) {
            EXPECT_EQ(graph.offset[f + 1] - graph.offset[f], sides == 64 ? 63 : 32);
            for (Index i = graph.offset[f]; i < graph.offset[f + 1]; ++i) pairs.insert({f, graph.neighbor[i]});
        }
        for (const auto& [f, g] : pairs) EXPECT_TRUE(pairs.count({g, f})) << f << ' ' << g;
        for (const auto& e : graph.edges) EXPECT_TRUE(pairs.count(e));
    }
}

TEST(NormalField, PagesOfABookAreNotAllNeighbours) {
    Mesh book;
    book.positions = {{0, 0, 0}, {0, 0, 1}};
    for (Index i = 0; i < 3000; ++i) {
        book.positions.emplace_back(std::cos(0.002 * i), std::sin(0.002 * i), 0.5);
        book.faces.push_back({0, 1, i + 2});
    }
    const FaceGraph graph = face_graph(book.faces, incidence_of(book));
    EXPECT_TRUE(graph.neighbor.empty());
    EXPECT_TRUE(graph.edges.empty());
}

TEST(NormalField, GivesUnitNormalsAndTicks) {
    const Mesh mesh = noisy(shapes::irregular_sphere(500), 0.2);
    NormalFieldStats stats;
    std::vector<double> ticks;
    const auto normals = denoise_normals(mesh.faces, mesh.positions, face_graph(mesh.faces, incidence_of(mesh)), {},
                                         stats, [&](double f) { ticks.push_back(f); });
    for (const Vec3& n : normals) EXPECT_NEAR(n.norm(), 1, 1e-12);
    EXPECT_GE(ticks.size(), 10u);
    EXPECT_TRUE(std::is_sorted(ticks.begin(), ticks.end()));
    EXPECT_LE(ticks.back(), 1);
}

TEST(NormalField, FacesWithoutAreaHaveNoWeight) {
    const Mesh mesh = noisy(shapes::irregular_sphere(1000), 0.15);
    Mesh more = mesh;
    for (Index v = 0; v < 900; ++v) more.faces.push_back({v, v, mesh.faces[v][0]});
    NormalFieldStats plain, with_more;
    const auto expected = denoised_normals(mesh, plain);
    auto normals = denoised_normals(more, with_more);
    EXPECT_NEAR(with_more.noise, plain.noise, 1e-6);
    EXPECT_EQ(normals.back(), Vec3(Vec3::Zero()));
    normals.resize(expected.size());
    EXPECT_LE(largest_distance(normals, expected), 1e-5);
}

TEST(FitVertices, SurfacesThatFitTheirNormalsStay) {
    for (const Mesh& mesh :
         {shapes::plane(12), shapes::icosphere(8), shapes::torus(20, 10), shapes::open_cylinder(12, 6)})
        EXPECT_LE(largest_distance(fitted(mesh, face_normals(mesh.faces, mesh.positions)), mesh.positions), 1e-14);
}

TEST(FitVertices, NormalsOfZeroHaveNoWeight) {
    const Mesh mesh = noisy(shapes::irregular_sphere(300), 0.2);
    EXPECT_EQ(fitted(mesh, Array<Vec3>(mesh.faces.size(), Vec3::Zero())), mesh.positions);
}

TEST(FitVertices, NoisyPlaneBecomesFlatAndMovesAlongItsNormalOnly) {
    const Mesh plane = shapes::plane(30, {0.1, 0, 1});  // no triangle is so thin that it would slide
    const Mesh mesh = noisy(plane, 0.1);
    const Positions p = fitted(mesh, Array<Vec3>(mesh.faces.size(), Vec3(0, 0, 1)));
    double before = 0, after = 0, mean = 0, mean_before = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        EXPECT_EQ(p[i].head<2>(), plane.positions[i].head<2>());
        before += mesh.positions[i].z() * mesh.positions[i].z();
        after += p[i].z() * p[i].z();
        mean += p[i].z() / p.size();
        mean_before += mesh.positions[i].z() / p.size();
    }
    EXPECT_LT(after, 0.06 * before);
    EXPECT_NEAR(mean, mean_before, 0.1 * std::sqrt(before / p.size()));
}

TEST(FitVertices, TrueNormalsBringANoisyBlockBack) {
    const Mesh block = shapes::block(8);
    const auto truth = face_normals(block.faces, block.positions);
    const Mesh mesh = noisy(block, 0.2);
    const Error before = error_of(block, mesh.positions), after = error_of(block, fitted(mesh, truth, 30));
    EXPECT_LT(after.angle, 0.1 * before.angle);
    EXPECT_LT(after.rms, 0.4 * before.rms);
    EXPECT_EQ(after.folded, 0);
}

TEST(FitVertices, FoldedFacesUnfold) {
    Mesh mesh = shapes::plane(12, {0.2, 0, 1});
    const Mesh truth = mesh;
    const Index middle = 6 * 13 + 6;
    mesh.positions[middle] += Vec3(0.13, 0.02, 0);  // past its neighbour
    ASSERT_GT(error_of(truth, mesh.positions).folded, 0);
    const Positions p = fitted(mesh, face_normals(truth.faces, truth.positions));
    EXPECT_EQ(error_of(truth, p).folded, 0);
    for (std::size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(p[i].z(), 0, 1e-12);
}

}  // namespace multires
