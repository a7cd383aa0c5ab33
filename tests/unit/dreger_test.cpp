#include "filters/attributes/attributes_band.h"
#include "filters/attributes/attributes_denoise.h"
#include "filters/attributes/texcoord.h"
#include "filters/grid/grid_band.h"
#include "filters/grid/grid_level.h"
#include "filters/layers/levels.h"
#include "filters/shape/denoise.h"

#include "attribute_fixtures.h"
#include "filter_fixtures.h"
#include "measure/measure.h"
#include "scheme_fixtures.h"
#include "suited.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

// The scheme of triangular grids in the filters of all meshes; scheme_test.cpp has what is true of every scheme.

namespace multires {
namespace {

using fixtures::largest_distance;
using fixtures::layer_of;
using fixtures::refusal;

PyramidOptions dreger() {
    PyramidOptions options;
    options.scheme.row = scheme_named("Dreger");
    return options;
}

Mesh terrain(double noise = 0.2) {
    shapes::GridShape shape;
    shape.rows = 60, shape.columns = 70, shape.hole = 6, shape.noise = noise;
    return shapes::grid_terrain(shape);
}

}  // namespace

TEST(Dreger, BandsAreThoseOfTheGridFilter) {
    const Layer layer = layer_of(terrain());
    for (const Band& band : {Band{Unit::level, 0, 2, 0}, Band{Unit::wavelength, 5, 17, 0.5}}) {
        BandOptions options;
        options.calibration.method = BandMethod::pyramid;
        options.band = band, options.gain = 2.5, options.pyramid = dreger();
        GridBandOptions grid;
        grid.band = band, grid.gain = 2.5;
        Session one, other;
        const Positions after = *scale_band(layer, options, one).positions;
        EXPECT_LT(largest_distance(after, *grid_band(layer, grid, other).positions), 1e-12);
        EXPECT_GT(largest_distance(after, layer.mesh.positions), 0.1);
    }
}

TEST(Dreger, BandsOfAttributesAreThoseOfHeights) {
    Layer layer = layer_of(terrain());
    std::vector<double> z;
    for (const Vec3& p : layer.mesh.positions) z.push_back(p.z());
    layer.attributes.push_back({AttributeKind::quality, "", 1, z});
    AttributeBandOptions options;
    options.calibration.method = BandMethod::pyramid;
    options.what.quality = true, options.pyramid = dreger(), options.mode = BandMode::stop_band;
    options.band = {Unit::level, 0, 2, 0};
    GridBandOptions grid;
    grid.band = options.band;
    Session session;
    const std::vector<double> after = filter_attribute_bands(layer, options, session).attributes[0].values;
    const Positions moved = *grid_band(layer, grid, session).positions;
    for (std::size_t v = 0; v < after.size(); ++v) EXPECT_NEAR(after[v], moved[v].z(), 1e-12);
}

TEST(Dreger, LevelsAreGridsOfTwiceTheCellsOnTheSmoothSurface) {
    const Layer layer = layer_of(terrain());
    GenerateLevelOptions options;
    options.pyramid = dreger(), options.level = 2, options.smoothed = true;
    GridLevelOptions grid;
    grid.level = 2, grid.refine = 2;
    Session session;
    const DerivedMesh level = *generate_level(layer, options, session).layer;
    const DerivedMesh surface = *generate_grid_level(layer, grid, session).layer;
    for (std::size_t v = 0; v < level.source_vertex.size(); ++v)
        EXPECT_LT(((*level.positions)[v] - (*surface.positions)[level.source_vertex[v]]).norm(), 1e-12);
    EXPECT_LT(level.source_vertex.size(), layer.mesh.positions.size() / 15);
    // Beside the outline and the hole a cell may stand for less than 16.
    Index of_cells = 0;
    for (const Face& f : level.faces) {
        const auto at = [&](int k) { return layer.mesh.positions[level.source_vertex[f[k]]]; };
        const double area = (at(1) - at(0)).cross(at(2) - at(0)).z();
        EXPECT_GT(area, 0);
        of_cells += std::abs(area - 16) < 1e-9;
    }
    EXPECT_GT(of_cells, 0.8 * static_cast<double>(level.faces.size()));
}

TEST(Dreger, ReconstructsExactlyAndCountsOctaves) {
    const Layer layer = layer_of(terrain());
    Session session;
    ComputePyramidOptions options;
    options.pyramid = dreger();
    const Report report = compute_pyramid(layer, options, session).report;
    EXPECT_LT(fixtures::number(report, "reconstruction_error"), 1e-12);
    const std::vector<double> wavelength = fixtures::series(report, "wavelength");
    ASSERT_GE(wavelength.size(), 4u);
    for (std::size_t k = 1; k < wavelength.size(); ++k) EXPECT_EQ(wavelength[k], 2 * wavelength[k - 1]);
}

// Each seed is another hierarchy, as cycle spinning wants: the grid's cells begin elsewhere.
TEST(Dreger, SeedsShiftTheGrid) {
    const Mesh mesh = terrain();
    HierarchyOptions options;
    const Hierarchy first = fixtures::hierarchy_for(scheme_named("Dreger"), mesh, options);
    int other = 0;
    for (options.seed = 1; options.seed < 6; ++options.seed) {
        const Hierarchy h = fixtures::hierarchy_for(scheme_named("Dreger"), mesh, options);
        SchemeOptions scheme;
        scheme.row = scheme_named("Dreger");
        const auto made = make_scheme(h, scheme);
        const Positions again = positions_in_input(h, made->synthesise(made->analyse(field_of(h.positions))));
        EXPECT_LT(largest_distance(again, mesh.positions), 1e-12);
        other += h.order != first.order;
    }
    EXPECT_EQ(other, 5);
}

TEST(Dreger, SeveralGridsAndVerticesInNoneComeBack) {
    Mesh mesh = shapes::join(terrain(), shapes::grid_terrain(), Vec3(100, 0, 0));
    mesh.positions.emplace_back(7, 7, 7);
    const Pyramid pyramid(layer_of(mesh), dreger(), Progress());
    EXPECT_EQ(pyramid.hierarchy().isolated, 1);
    EXPECT_LT(largest_distance(pyramid.synthesise({}), mesh.positions), 1e-12);
    const std::vector<double> none(pyramid.hierarchy().levels.size(), 0);
    EXPECT_EQ(pyramid.synthesise(none).back(), Vec3(7, 7, 7));
}

TEST(Dreger, DamagedGridsComeBackOrAreRefused) {
    int worked = 0, levels = 0;
    for (std::uint64_t seed = 1; seed <= 120; ++seed) {
        SCOPED_TRACE(seed);
        const Layer layer = layer_of(plugin::random_grid(seed));
        PyramidOptions options = dreger();
        options.hierarchy.base_vertices = 4, options.hierarchy.seed = static_cast<int>(seed % 3);
        Session session;
        Report report;
        try {
            const auto pyramid = pyramid_of(layer, options, session, report);
            EXPECT_LT(largest_distance(pyramid->synthesise({}), layer.mesh.positions), 1e-11);
            levels += static_cast<int>(pyramid->hierarchy().levels.size());
            ++worked;
        } catch (const InputError& e) {
            EXPECT_EQ(std::string(e.what()).find("scheme: Dreger"), 0u) << e.what();
        }
    }
    EXPECT_GT(worked, 60);
    EXPECT_GT(levels, worked / 2);
}

TEST(Dreger, TakesMostOfTheNoiseOfATerrain) {
    const Mesh clean = terrain(0);
    Mesh noisy = clean;
    shapes::Random random(3);
    for (Vec3& p : noisy.positions)
        for (int i = 0; i < 12; ++i) p.z() += 0.2 * (random.uniform(0, 1) - 0.5);  // about 0.2 cells
    const auto error = [&](const Positions& p) {
        double sum = 0;
        for (std::size_t v = 0; v < p.size(); ++v) sum += (p[v] - clean.positions[v]).squaredNorm();
        return std::sqrt(sum / static_cast<double>(p.size()));
    };
    for (const DenoiseMethod method : {DenoiseMethod::soft_threshold, DenoiseMethod::hard_threshold}) {
        DenoiseOptions options;
        options.method = method, options.pyramid = dreger();
        Session session;
        const Positions after = *denoise(layer_of(noisy), options, session).positions;
        EXPECT_LT(error(after), 0.75 * error(noisy.positions));
    }
}

TEST(Dreger, RefusesByName) {
    const Layer grid = layer_of(terrain()), sphere = layer_of(shapes::irregular_sphere(500));
    Session session;
    ComputePyramidOptions options;
    options.pyramid = dreger();
    EXPECT_EQ(refusal([&] { compute_pyramid(sphere, options, session); }).find("scheme: Dreger is for triangular"), 0u);
    options.pyramid.features.from = Features::angle;
    EXPECT_EQ(refusal([&] { compute_pyramid(grid, options, session); }).find("features: the scheme Dreger"), 0u);
    TexcoordOptions texcoord;
    texcoord.projection = Projection::planar, texcoord.pyramid = dreger();
    EXPECT_EQ(refusal([&] { generate_texcoord(grid, texcoord, session); }).find("scheme: Dreger does not start"), 0u);
}

}  // namespace multires
