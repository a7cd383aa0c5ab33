#include "mesh/specks.h"

#include "denoise_fixtures.h"
#include "filter_fixtures.h"
#include "filters/shape/band_filters.h"
#include "filters/shape/denoise.h"

// Float beside a scan: small parts that cannot be made coarser, and are too small to be measured.

namespace multires {
namespace {

using fixtures::layer_of;

/// A mesh with tetrahedra of a few edge lengths above it.
Mesh with_float(Mesh mesh, int count, double size) {
    Mesh speck = shapes::tetrahedron();
    for (Vec3& p : speck.positions) p *= size;
    for (int i = 0; i < count; ++i)
        mesh = shapes::join(mesh, speck, {3 + 10 * size * (i % 20), 10 * size * (i / 20), 0.3 * i * size});
    return mesh;
}

/// Of the vertices of the first mesh.
double largest_distance_of(const Positions& a, Positions b) {
    b.resize(a.size());
    return fixtures::largest_distance(a, b);
}

}  // namespace

TEST(Specks, AreSmallPartsBesideALargeOne) {
    const Mesh sphere = shapes::irregular_sphere(2000);
    const auto faces = sphere.faces.size();
    Layer layer = layer_of(with_float(sphere, 3, 0.05));
    layer.selected_face.assign(layer.mesh.faces.size(), 0);
    layer.selected_face[faces - 1] = 1;
    std::rotate(layer.mesh.faces.begin(), layer.mesh.faces.begin() + 6, layer.mesh.faces.end());
    std::rotate(layer.selected_face.begin(), layer.selected_face.begin() + 6, layer.selected_face.end());
    const auto found = without_specks(layer);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->specks, 3);
    EXPECT_EQ(found->layer.mesh.positions, layer.mesh.positions);
    ASSERT_EQ(found->layer.mesh.faces.size(), faces);
    for (std::size_t f = 0; f < faces; ++f)
        EXPECT_EQ(found->layer.selected_face[f], found->layer.mesh.faces[f] == sphere.faces.back());
    EXPECT_FALSE(without_specks(layer_of(sphere)));
    EXPECT_FALSE(without_specks(layer_of(with_float(shapes::irregular_sphere(300), 3, 0.05))));
    EXPECT_FALSE(without_specks(layer_of(with_float(shapes::tetrahedron(), 50, 1))));
}

TEST(Specks, DoNotMakeLevelsFiner) {
    const Mesh sphere = shapes::scan(4000, {});
    const Layer alone = layer_of(sphere), beside = layer_of(with_float(sphere, 200, 0.04));
    for (const char* scheme : {"Guskov", "Roy", "Szczesna"}) {
        SCOPED_TRACE(scheme);
        LowPassOptions options;
        options.pyramid.scheme.row = scheme_named(scheme);
        options.cutoff = 0.3;
        Session first, second;
        const double moved = largest_distance_of(sphere.positions, *low_pass(alone, options, first).positions);
        EXPECT_LT(largest_distance_of(sphere.positions, *low_pass(beside, options, second).positions), 1.5 * moved);
    }
}

TEST(Specks, DoNotKeepNoiseFromBeingFound) {
    const Mesh block = shapes::block(20);
    Mesh noisy = block;
    noisy.positions = fixtures::with_noise(block, 0.1);
    const Layer alone = layer_of(noisy), beside = layer_of(with_float(noisy, 60, 0.1));
    for (const DenoiseMethod method : {DenoiseMethod::automatic, DenoiseMethod::soft_threshold}) {
        DenoiseOptions options;
        options.method = method;
        Session first, second;
        const Result a = denoise(alone, options, first), b = denoise(beside, options, second);
        const double noise = fixtures::number(a.report, "noise");
        EXPECT_NEAR(fixtures::number(b.report, "noise"), noise, 0.03 * noise);
        double squares = 0;
        for (std::size_t i = 0; i < noisy.positions.size(); ++i)
            squares += ((*a.positions)[i] - (*b.positions)[i]).squaredNorm();
        EXPECT_LT(std::sqrt(squares / static_cast<double>(noisy.positions.size())), 0.1 * noise);
        for (std::size_t i = noisy.positions.size(); i < beside.mesh.positions.size(); ++i)
            EXPECT_EQ((*b.positions)[i], beside.mesh.positions[i]);
    }
}

}  // namespace multires
