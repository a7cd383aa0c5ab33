#include "filters/editing/smooth_base.h"

#include "base/angles.h"
#include "filter_fixtures.h"
#include "measure/measure.h"
#include "solvers/system.h"

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

/// A disc of rings around a hub with as many neighbours.
Mesh wheel(Index neighbours, int rings) {
    Mesh mesh;
    mesh.positions.push_back(Vec3::Zero());
    const auto at = [&](int ring, Index k) { return 1 + (ring - 1) * neighbours + k % neighbours; };
    for (int ring = 1; ring <= rings; ++ring)
        for (Index k = 0; k < neighbours; ++k) {
            const double angle = 2 * pi * k / neighbours, r = static_cast<double>(ring) / rings;
            mesh.positions.push_back(r * Vec3(std::cos(angle), std::sin(angle), 0));
            if (ring == 1) mesh.faces.push_back({0, at(1, k), at(1, k + 1)});
            if (ring == 1) continue;
            mesh.faces.push_back({at(ring - 1, k), at(ring, k), at(ring, k + 1)});
            mesh.faces.push_back({at(ring - 1, k), at(ring, k + 1), at(ring - 1, k + 1)});
        }
    return mesh;
}

// The bending energy leaves out the Laplacian at vertices of more than 100 neighbours, but not the vertices: those of
// their neighbours hold them.
TEST(SmoothBase, OfAHubWithManyNeighboursIsAsSmoothAsOfOneWithFew) {
    constexpr int rings = 8;
    const auto hub = [](Index neighbours, const auto& height) {
        const Mesh disc = wheel(neighbours, rings);
        SystemOptions how;
        how.bending = true;
        how.fixed.assign(disc.positions.size(), 1);
        Array<double> z(disc.positions.size()), nothing(disc.positions.size(), 0.0);
        for (std::size_t v = 0; v < z.size(); ++v) z[v] = height(disc.positions[v]);
        for (std::size_t v = 0; v < z.size() - 3 * static_cast<std::size_t>(neighbours); ++v)
            how.fixed[v] = 0, z[v] = std::sin(static_cast<double>(v));
        const System solver(disc, how);
        SolveOptions options;
        options.tolerance = 1e-10;
        solver.solve(0, 1, ConstRows(nothing, 1), Rows(z, 1), options);
        double largest = 0;
        for (std::size_t v = 0; v < z.size(); ++v)
            largest = std::max(largest, std::abs(z[v] - height(disc.positions[v])));
        return std::make_pair(z[0], largest);
    };
    const auto plane = [](const Vec3& p) { return 1 + 2 * p.x() - p.y(); };
    const auto bowl = [](const Vec3& p) { return p.squaredNorm(); };
    for (const Index neighbours : {12, 101, 200}) {
        SCOPED_TRACE(neighbours);
        EXPECT_LT(hub(neighbours, plane).second, 1e-4) << "linear functions have no bending energy";
        EXPECT_NEAR(hub(neighbours, bowl).first, 0, 0.02) << "nor has the hub of a bowl a tip";
    }
}

/// A rod as CAD programs write it: each side two triangles of its whole length, the ends fans from one corner, and
/// vertices on many edges that leave triangles without an area.
Mesh rod(Index sides) {
    Mesh mesh;
    for (Index k = 0; k < sides; ++k)
        for (const double z : {0.0, 10.0}) {
            const double angle = 2 * pi * k / sides;
            mesh.positions.push_back({std::cos(angle), std::sin(angle), z});
        }
    for (Index k = 0; k < sides; ++k) {
        const Index a = 2 * k, b = 2 * ((k + 1) % sides);
        const Index middle = static_cast<Index>(mesh.positions.size());
        mesh.positions.push_back(0.3 * mesh.positions[a] + 0.7 * mesh.positions[b]);
        mesh.faces.push_back({a, b, b + 1});
        mesh.faces.push_back({a, b + 1, a + 1});
        mesh.faces.push_back({a, middle, b});  // no area
        if (k > 1) {
            mesh.faces.push_back({0, middle, a}), mesh.faces.push_back({0, b, middle});
            mesh.faces.push_back({1, a + 1, b + 1});
        }
    }
    return mesh;
}

TEST(SmoothBase, OfNeedlesAndFacesWithoutAreaStaysWithTheMesh) {
    for (const Index sides : {100, 400, 1000}) {
        SCOPED_TRACE(sides);
        const Mesh mesh = rod(sides);
        const Result r = base(layer_of(mesh), 150);
        EXPECT_LT(displacement(mesh.positions, *r.layer->positions).largest, 1);
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
