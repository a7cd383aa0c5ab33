#include "filters/editing/smooth_base.h"

#include "filter_fixtures.h"
#include "measure/measure.h"
#include "solvers/stiffness.h"

// Smooth Base as Layer.

namespace multires {
namespace {

using fixtures::count;
using fixtures::layer_of;

Result base(const Layer& layer, int vertices) {
    Session session;
    SmoothBaseOptions options;
    options.vertices = vertices;
    return generate_base(layer, options, session);
}

/// The integral of the squared Laplacian.
double energy(const Mesh& mesh, const Positions& x) {
    const Stiffness b = bending(stiffness(mesh));
    Array<double> bx(3 * x.size());
    apply_stiffness(b, x[0].data(), 3, bx.data());
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        for (int d = 0; d < 3; ++d) sum += x[i][d] * bx[3 * i + d];
    return sum;
}

}  // namespace

TEST(SmoothBase, KeepsAllVerticesAndFacesAndSoManyPlacesOnEveryClassOfMesh) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        const auto all = static_cast<int>(mesh.positions.size());
        const Result whole = base(layer_of(mesh), all);
        EXPECT_EQ(*whole.layer->positions, mesh.positions);
        EXPECT_EQ(whole.layer->faces, mesh.faces);
        Session session;
        Report report;
        const auto pyramid = pyramid_of(layer_of(mesh), {}, session, report);
        const int least = pyramid->hierarchy().size.back(), kept = (least + all) / 2;
        const Result r = base(layer_of(mesh), kept);
        int same = 0;
        for (int v = 0; v < all; ++v) {
            EXPECT_EQ(r.layer->source_vertex[v], v);
            EXPECT_TRUE((*r.layer->positions)[v].allFinite());
            same += (*r.layer->positions)[v] == mesh.positions[v];
        }
        EXPECT_GE(same, kept);
        EXPECT_EQ(count(r.report, "vertices_kept"), kept);
    }
}

TEST(SmoothBase, HasLeastBendingEnergyOfAllShapesThroughTheVerticesKept) {
    const Mesh mesh = shapes::scan(4000, {0.2, 0.3, 5});
    const Result r = base(layer_of(mesh), 400);
    const double least = energy(mesh, *r.layer->positions);
    EXPECT_LT(least, 0.5 * energy(mesh, mesh.positions));  // a tenth of the vertices lies on the bumps as before
    // A step in any direction that leaves the kept vertices alone does not lower it.
    for (int k = 0; k < 4; ++k) {
        Positions other = *r.layer->positions;
        for (std::size_t v = 0; v < other.size(); ++v)
            if (other[v] != mesh.positions[v])
                other[v] += 1e-4 * Vec3(std::sin(k + 5 * other[v].x()), std::cos(k * other[v].y()), k - other[v].z());
        EXPECT_GT(energy(mesh, other), least);
    }
}

TEST(SmoothBase, KeepsTheBaseAtLeastAndRefusesMoreThanAll) {
    const Layer layer = layer_of(shapes::scan(2000));
    EXPECT_EQ(*base(layer, 3).layer->positions, *base(layer, 100).layer->positions) << "the base has about 100";
    try {
        base(layer, 1000000);
        FAIL();
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find(std::to_string(layer.mesh.positions.size()) + ", all that"),
                  std::string::npos)
            << e.what();
    }
}

}  // namespace multires
