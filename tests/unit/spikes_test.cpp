#include "normals/spikes.h"

#include "denoise_fixtures.h"

namespace multires {

using namespace fixtures;

namespace {

Positions despiked(const Mesh& mesh, Index& spikes) {
    return without_spikes(mesh.faces, mesh.positions,
                          vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size())), spikes);
}

}  // namespace

TEST(Spikes, ShapesAndGaussianNoiseHaveNone) {
    for (const Mesh& shape : {shapes::plane(30), shapes::irregular_sphere(3000), shapes::block(8), shapes::scan(3000)})
        for (const double noise : {0.0, 0.1, 0.3}) {
            Mesh mesh = shape;
            mesh.positions = with_noise(shape, noise);
            Index spikes = -1;
            EXPECT_EQ(despiked(mesh, spikes), mesh.positions);
            EXPECT_EQ(spikes, 0);
        }
    for (const auto& [name, mesh] : every_class()) {
        SCOPED_TRACE(name);
        Index spikes = -1;
        for (const Vec3& p : despiked(mesh, spikes)) EXPECT_TRUE(p.allFinite());
    }
}

TEST(Spikes, ThoseOnAPlaneGoBackExactlyAndNobodyElseMoves) {
    const Mesh plane = shapes::plane(30, {0.2, 0, 1});
    Mesh mesh = plane;
    Index set = 0;
    // Two edges inside the boundary, and far enough from one another for a clean plane between them.
    for (Index y = 3; y < 28; y += 4)
        for (Index x = 3; x < 28; x += 4) {
            mesh.positions[y * 31 + x].z() = (x % 8 == 3 ? 1 : -1) * 0.02;
            ++set;
        }
    Index spikes = 0;
    const Positions p = despiked(mesh, spikes);
    EXPECT_EQ(spikes, set);
    EXPECT_LE(largest_distance(p, plane.positions), 1e-12);
}

}  // namespace multires
