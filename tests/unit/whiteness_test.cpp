#include "denoise/whiteness.h"

#include "measure/vertex_normals.h"

#include "denoise_fixtures.h"

namespace multires {

using namespace fixtures;

namespace {

double whiteness_of(const Mesh& mesh, const Positions& positions) {
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(positions.size()));
    const Neighbours near = neighbours(mesh.faces, at);
    return whiteness(near, positions, multires::vertex_normals(mesh.faces, multires::taubin(near, positions, 10)));
}

}  // namespace

TEST(Whiteness, TellsNoiseThatIsEverywhereFromImpulsesAndTexture) {
    for (const Mesh& mesh : {shapes::irregular_sphere(5000), shapes::scan(5000), shapes::plane(70)}) {
        for (const double deviation : {0.1, 0.2, 0.4}) {
            EXPECT_GT(whiteness_of(mesh, with_noise(mesh, deviation)), 0.88);
            EXPECT_LT(whiteness_of(mesh, with_noise(mesh, deviation, NoiseKind::impulsive)), 0.8);
        }
        Positions half = with_noise(mesh, 0.2);
        for (std::size_t i = 0; i < half.size(); ++i)
            if (mesh.positions[i].x() > 0.3) half[i] = mesh.positions[i] + 0.2 * (half[i] - mesh.positions[i]);
        EXPECT_LT(whiteness_of(mesh, half), 0.88);
    }
    EXPECT_LT(whiteness_of(shapes::block(30), shapes::block(30).positions), 0.1);
}

TEST(Whiteness, OfNextToNothingIsANumber) {
    for (const auto& [name, mesh] : every_class()) {
        const double w = whiteness_of(mesh, mesh.positions);
        EXPECT_GE(w, 0) << name;
        EXPECT_LE(w, 1) << name;
    }
}

}  // namespace multires
