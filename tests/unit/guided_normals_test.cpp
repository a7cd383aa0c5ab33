#include "normals/guided_normals.h"

#include "denoise_fixtures.h"
#include "normals/falling_weight.h"
#include "normals/normal_field.h"

namespace multires {

using namespace fixtures;

namespace {

Positions guided(const Mesh& mesh, int steps, const std::vector<std::uint8_t>& moves = {}) {
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()));
    return guided_steps(mesh.faces, mesh.positions, at, face_graph(mesh.faces, at), steps, moves);
}

Mesh after_normal_field(Mesh mesh) {
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()));
    NormalFieldStats stats;
    const Array<Vec3> normals =
        denoise_normals(mesh.faces, mesh.positions, face_graph(mesh.faces, at), {}, stats, [](double) {});
    mesh.positions = fit_vertices(mesh.faces, mesh.positions, at, normals, 8);
    return mesh;
}

}  // namespace

TEST(GuidedNormals, SharpenWhatTheNormalFieldLeavesOfABlock) {
    const Mesh truth = shapes::block(15);
    for (const double deviation : {0.2, 0.3}) {
        Mesh mesh = truth;
        mesh.positions = with_noise(truth, deviation);
        mesh = after_normal_field(mesh);
        EXPECT_LE(error_of(truth, guided(mesh, 8)).angle, 0.8 * error_of(truth, mesh.positions).angle) << deviation;
    }
}

TEST(GuidedNormals, LeaveFacesAndEdgesOfAPolyhedronAlone) {
    // Every patch that holds a face in a corner goes around an edge: corners are rounded.
    const Mesh block = shapes::block(9);
    const double edge = mean_edge_length(block.faces, block.positions);
    const Positions after = guided(block, 4);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < after.size(); ++i) moved += (after[i] - block.positions[i]).norm() > 0.05 * edge;
    EXPECT_LT(moved, after.size() / 10);
}

TEST(GuidedNormals, MoveOnlyWhatMayMove) {
    Mesh mesh = shapes::irregular_sphere(500);
    mesh.positions = with_noise(mesh, 0.2);
    std::vector<std::uint8_t> moves(mesh.positions.size(), 0);
    for (std::size_t i = 0; i < moves.size(); i += 3) moves[i] = 1;
    const Positions after = guided(mesh, 2, moves);
    for (std::size_t i = 0; i < moves.size(); ++i) EXPECT_EQ(after[i] != mesh.positions[i], moves[i] != 0) << i;
}

TEST(FallingWeight, IsTheExponential) {
    for (double x = 0; x < 100; x = 1.01 * x + 0.003) EXPECT_NEAR(falling_weight(x) / std::exp(-x), 1, 1e-8) << x;
}

TEST(GuidedNormals, TakeAnyMesh) {
    for (const auto& named : every_class()) {
        SCOPED_TRACE(named.first);
        for (const Vec3& p : guided(named.second, 2)) ASSERT_TRUE(p.allFinite());
    }
}

}  // namespace multires
