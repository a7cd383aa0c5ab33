#include "filters/grid/grid_attributes.h"
#include "filters/grid/grid_band.h"
#include "filters/grid/grid_compress.h"
#include "filters/grid/grid_level.h"

#include "attribute_fixtures.h"
#include "base/reduce.h"
#include "filter_fixtures.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <string>

// What the filters of triangular grids compute.

namespace multires {
namespace {

using fixtures::largest_distance;
using fixtures::layer_of;

shapes::GridShape with_hole() {
    shapes::GridShape shape;
    shape.rows = 40, shape.columns = 50, shape.hole = 6;
    return shape;
}

Positions band(const Layer& layer, const GridBandOptions& options) {
    Session session;
    return *grid_band(layer, options, session).positions;
}

/// Options that keep what is coarser than some levels.
GridBandOptions without_levels(int count, SplineBasis basis = SplineBasis::quartic) {
    GridBandOptions options;
    options.gains = "0";
    for (int k = 1; k < count; ++k) options.gains += ", 0";
    options.grid.basis = basis;
    return options;
}

DerivedMesh level(const Layer& layer, int number, int refine, SplineBasis basis = SplineBasis::quartic) {
    GridLevelOptions options;
    options.level = number, options.refine = refine, options.grid.basis = basis;
    Session session;
    return *generate_grid_level(layer, options, session).layer;
}

Layer layer_of_level(const DerivedMesh& derived) {
    Layer layer;
    layer.mesh.positions = *derived.positions;
    layer.mesh.faces = derived.faces;
    return layer;
}

Positions edited(const Layer& layer, const Layer& control, GridEditOptions options = {}) {
    Session session;
    options.edited.place = 0;
    return *grid_edit({layer, {&control}}, options, session).positions;
}

Result compress(const Layer& layer, const GridCompressOptions& options) {
    Session session;
    return grid_compress(layer, options, session);
}

}  // namespace

TEST(ComputeGrid, TellsSizeHolesAndExactReconstruction) {
    const Layer layer = layer_of(shapes::grid_terrain(with_hole()));
    Session session;
    const Result r = compute_grid(layer, {}, session);
    EXPECT_EQ(fixtures::count(r.report, "grids"), 1);
    const std::set<double> sides{fixtures::series(r.report, "rows")[0], fixtures::series(r.report, "columns")[0]};
    EXPECT_EQ(sides, (std::set<double>{40, 50}));
    EXPECT_EQ(fixtures::series(r.report, "holes"), std::vector<double>{1});
    EXPECT_EQ(fixtures::series(r.report, "energy").size(), 7u * fixtures::count(r.report, "levels"));
    EXPECT_LT(fixtures::number(r.report, "reconstruction_error"), 1e-12);
}

TEST(GridBand, GainsOfOneLeaveEveryVertexExactlyWhereItIs) {
    const Layer layer = layer_of(shapes::grid_terrain(with_hole()));
    GridBandOptions options;
    options.gain = 1, options.band.coarsest = 10;
    EXPECT_EQ(band(layer, options), layer.mesh.positions);
    options.gains = "1, 1";
    EXPECT_EQ(band(layer, options), layer.mesh.positions);
}

TEST(GridBand, APlaneHasNoDetailNotEvenAtItsOutline) {
    Mesh mesh = shapes::grid_terrain(with_hole());
    for (Vec3& p : mesh.positions) p.z() = 0.3 * p.x() - 0.2 * p.y() + 5;
    for (const SplineBasis basis : {SplineBasis::linear, SplineBasis::quartic})
        EXPECT_LT(largest_distance(band(layer_of(mesh), without_levels(3, basis)), mesh.positions), 1e-12);
}

TEST(GridBand, HeightsMoveAlongZOnlyHoweverTheTerrainSlopes) {
    Mesh mesh = shapes::grid_terrain(with_hole());
    for (Vec3& p : mesh.positions) p.z() += 0.7 * p.x();
    GridBandOptions options = without_levels(2);
    options.grid.channels = GridChannels::heights;
    const Positions after = band(layer_of(mesh), options);
    double along = 0, across = 0;
    for (std::size_t v = 0; v < after.size(); ++v) {
        const Vec3 way = after[v] - mesh.positions[v];
        along = std::max(along, std::abs(way.z())), across = std::max(across, std::hypot(way.x(), way.y()));
    }
    EXPECT_GT(along, 0.1);
    EXPECT_LT(across, 1e-12);
}

/// RMS changes of heights by a low pass of three levels, inside and at the outline and around the hole.
std::array<double, 2> changes(Mesh mesh) {
    const Positions after = band(layer_of(mesh), without_levels(3));
    Mean squares[2];
    const Rings rings = vertex_rings(mesh);
    for (std::size_t v = 0; v < after.size(); ++v)
        squares[rings.kind[v] != RingKind::closed].add((after[v] - mesh.positions[v]).squaredNorm());
    return {std::sqrt(squares[0].value()), std::sqrt(squares[1].value())};
}

// A guard against a rim that gets worse, not a proof that none can be seen.
TEST(GridBand, LeavesNoRim) {
    Mesh mesh = shapes::grid_terrain(with_hole());
    for (Vec3& p : mesh.positions) p.z() = 3 * std::sin(0.2 * p.x() + 0.1 * p.y()) + 0.01 * p.y() * p.y();
    const auto [inside, outside] = changes(mesh);
    EXPECT_LT(outside, 2 * inside);
}

TEST(GridBand, AGainScalesTheDetailsOfItsLevels) {
    const Layer layer = layer_of(shapes::grid_terrain(with_hole()));
    GridBandOptions options;
    options.band = {Unit::level, 0, 2, 0};
    options.gain = 0;
    const Positions none = band(layer, options);
    EXPECT_LT(largest_distance(none, band(layer, without_levels(2))), 1e-12);
    options.gain = 3;
    const Positions more = band(layer, options);
    for (std::size_t v = 0; v < more.size(); ++v) {
        const Vec3 detail = layer.mesh.positions[v] - none[v];
        EXPECT_NEAR((more[v] - layer.mesh.positions[v] - 2 * detail).norm(), 0, 1e-12);
    }
}

TEST(GridBand, RefusesGainsThatAreNoNumbers) {
    const Layer layer = layer_of(shapes::grid_terrain());
    GridBandOptions options;
    for (const char* text : {"x", "1, two", "nan", "1;2", "1e", "0.5x"}) {
        options.gains = text;
        EXPECT_THROW(band(layer, options), InputError) << text;
    }
    options.gains = "1, 0.5";
    const Positions expected = band(layer, options);
    for (const char* text : {" 1,0.5", "1 0.5 ", "1,,5e-1,"}) {
        options.gains = text;
        EXPECT_EQ(largest_distance(band(layer, options), expected), 0) << text;
    }
}

TEST(GridLevel, RefinedToTheGridItIsTheSurfaceWithoutFinerDetail) {
    const Layer layer = layer_of(shapes::grid_terrain(with_hole()));
    for (const SplineBasis basis : {SplineBasis::linear, SplineBasis::quartic}) {
        const DerivedMesh surface = level(layer, 2, 2, basis);
        EXPECT_EQ(surface.faces, layer.mesh.faces);
        EXPECT_LT(largest_distance(*surface.positions, band(layer, without_levels(2, basis))), 1e-12);
    }
}

TEST(GridLevel, HasFewerVerticesOrMoreAndFacesTheSameWayUp) {
    const Layer layer = layer_of(shapes::grid_terrain(with_hole()));
    const auto up = [](const DerivedMesh& mesh) {
        double least = 1e300;
        for (const Face& f : mesh.faces) {
            const Positions& p = *mesh.positions;
            least = std::min(least, (p[f[1]] - p[f[0]]).cross(p[f[2]] - p[f[0]]).z());
        }
        return least;
    };
    const DerivedMesh coarse = level(layer, 2, 0), fine = level(layer, 1, 3);
    EXPECT_LT(coarse.source_vertex.size(), layer.mesh.positions.size() / 6);
    EXPECT_NEAR(up(coarse), 16, 1e-9);  // cells of 4 by 4, and the terrain's x and y are exact
    EXPECT_EQ(fine.faces.size(), 16 * layer.mesh.faces.size());
    EXPECT_NEAR(up(fine), 1 / 16.0, 1e-9);
    for (const DerivedMesh* mesh : {&coarse, &fine})
        for (std::size_t v = 0; v < mesh->source_vertex.size(); ++v) {
            const Vec3 way = (*mesh->positions)[v] - layer.mesh.positions[mesh->source_vertex[v]];
            EXPECT_LT(std::hypot(way.x(), way.y()), 18) << "attributes come from far away";
        }
}

TEST(GridEdit, NothingMovesIfNothingWasEditedAndAllMovesWithAll) {
    const Layer layer = layer_of(shapes::grid_terrain(with_hole()));
    for (const int number : {0, 1, 3}) {
        Layer control = layer_of_level(level(layer, number, 0));
        EXPECT_EQ(edited(layer, control), layer.mesh.positions);
        for (Vec3& p : control.mesh.positions) p += Vec3(1, -2, 3);
        const Positions after = edited(layer, control);
        for (std::size_t v = 0; v < after.size(); ++v)
            EXPECT_NEAR((after[v] - layer.mesh.positions[v] - Vec3(1, -2, 3)).norm(), 0, 1e-12);
    }
}

TEST(GridEdit, OneControlPointMovesItsNeighbourhoodOnly) {
    const Layer layer = layer_of(shapes::grid_terrain(with_hole()));
    Layer control = layer_of_level(level(layer, 2, 0));
    std::size_t middle = 0;
    const auto distance = [](const Vec3& p) { return std::hypot(p.x() - 12, p.y() - 24); };
    for (std::size_t v = 0; v < control.mesh.positions.size(); ++v)
        if (distance(control.mesh.positions[v]) < distance(control.mesh.positions[middle])) middle = v;
    control.mesh.positions[middle].z() += 1;
    const Positions after = edited(layer, control);
    double most = 0;
    int moved = 0;
    for (std::size_t v = 0; v < after.size(); ++v) {
        const double way = (after[v] - layer.mesh.positions[v]).norm();
        most = std::max(most, way), moved += way > 1e-12;
        EXPECT_TRUE(way < 1e-12 || distance(layer.mesh.positions[v]) < 2 * 4 * std::sqrt(2.0) + 4);
    }
    EXPECT_NEAR(most, 0.5, 0.1);  // the function is 1/2 at its middle
    EXPECT_GT(moved, 20);
}

TEST(GridEdit, RefusesOtherLayersByName) {
    const Layer layer = layer_of(shapes::grid_terrain(with_hole())), other = layer_of(shapes::grid_terrain());
    try {
        edited(layer, other);
        FAIL();
    } catch (const InputError& e) {
        EXPECT_EQ(std::string(e.what()).find("edited: "), 0u);
    }
}

TEST(GridCompress, PursuitNeedsHalfTheErrorOfMagnitude) {
    const Layer layer = layer_of(shapes::grid_terrain(with_hole()));
    for (const SplineBasis basis : {SplineBasis::linear, SplineBasis::quartic}) {
        GridCompressOptions options;
        options.grid.basis = basis, options.grid.channels = GridChannels::heights;
        options.share = 15;
        double error[2];
        for (const Oracle oracle : {Oracle::magnitude, Oracle::pursuit}) {
            options.oracle = oracle;
            const Result r = compress(layer, options);
            error[static_cast<int>(oracle)] = fixtures::number(r.report, "rms_error");
            EXPECT_LE(fixtures::number(r.report, "kept_share"), 15.001);
            double squares = 0;
            for (std::size_t v = 0; v < layer.mesh.positions.size(); ++v)
                squares += ((*r.positions)[v] - layer.mesh.positions[v]).squaredNorm();
            const double rms = std::sqrt(squares / static_cast<double>(layer.mesh.positions.size()));
            EXPECT_NEAR(fixtures::number(r.report, "rms_error"), rms, 1e-12);
        }
        EXPECT_LT(error[1], 0.7 * error[0]);
    }
}

TEST(GridCompress, HonoursAnErrorBoundWithAsFewAsItCan) {
    const Layer layer = layer_of(shapes::grid_terrain(with_hole()));
    GridCompressOptions options;
    options.keep_by = KeepBy::error, options.error = 0.3;
    int kept[2];
    for (const Oracle oracle : {Oracle::magnitude, Oracle::pursuit}) {
        options.oracle = oracle;
        const Result r = compress(layer, options);
        EXPECT_LE(largest_distance(*r.positions, layer.mesh.positions), 0.3);
        kept[static_cast<int>(oracle)] = fixtures::count(r.report, "kept_coefficients");
    }
    EXPECT_LT(kept[1], kept[0]);
    EXPECT_LT(kept[1], 1000);
}

namespace {

/// Heights as quality, and as a custom scalar; colours by a pattern.
Layer painted() {
    Layer layer = layer_of(shapes::grid_terrain(with_hole()));
    std::vector<double> z, color;
    for (const Vec3& p : layer.mesh.positions) {
        z.push_back(p.z());
        for (const double c : {128 + 100 * std::sin(p.x()), 128 + 100 * std::sin(0.2 * p.y()), 40.0, 255.0})
            color.push_back(std::round(c));
    }
    layer.attributes = {{AttributeKind::color, "", 4, color},
                        {AttributeKind::quality, "", 1, z},
                        {AttributeKind::scalar, "height", 1, z}};
    return layer;
}

}  // namespace

TEST(GridAttributes, BandsOfHeightsAreThoseOfTheShape) {
    const Layer layer = painted();
    GridAttributeBandOptions options;
    options.what = {true, true, false, false, true, ""};
    options.band.gains = "0, 0.5";
    GridBandOptions shape = options.band;
    Session session;
    const Result r = grid_attributes_band(layer, options, session);
    const Positions moved = band(layer, shape);
    ASSERT_EQ(r.attributes.size(), 3u);
    for (std::size_t v = 0; v < moved.size(); ++v) {
        EXPECT_NEAR(r.attributes[1].values[v], moved[v].z(), 1e-12);
        EXPECT_NEAR(r.attributes[2].values[v], moved[v].z(), 1e-12);
        EXPECT_EQ(r.attributes[0].values[4 * v + 2], 40);  // constants stay exactly
        EXPECT_EQ(r.attributes[0].values[4 * v + 3], 255);
    }
    EXPECT_GT(fixtures::number(r.report, "color_rms_change"), 10);
    EXPECT_FALSE(r.positions);
}

TEST(GridAttributes, CompressionOfHeightsIsThatOfTheShape) {
    const Layer layer = painted();
    GridAttributeCompressOptions options;
    options.what.quality = true;
    options.compress.oracle = Oracle::magnitude, options.compress.grid.channels = GridChannels::heights;
    Session session;
    const Result r = grid_attributes_compress(layer, options, session);
    const Result shape = compress(layer, options.compress);
    EXPECT_EQ(fixtures::count(r.report, "quality_kept_coefficients"),
              fixtures::count(shape.report, "kept_coefficients"));
    EXPECT_NEAR(fixtures::number(r.report, "quality_rms_error"), fixtures::number(shape.report, "rms_error"), 1e-12);
    for (std::size_t v = 0; v < layer.mesh.positions.size(); ++v)
        EXPECT_NEAR(r.attributes[0].values[v], (*shape.positions)[v].z(), 1e-9);
}

TEST(GridAttributes, OfALevelAreTransformedLikeItsShape) {
    const Layer layer = painted();
    GridLevelOptions options;
    options.level = 2;
    Session session;
    for (const int refine : {0, 2, 3}) {
        options.refine = refine;
        const DerivedMesh made = *generate_grid_level(layer, options, session).layer;
        ASSERT_EQ(made.attributes.size(), 3u);
        for (std::size_t v = 0; v < made.source_vertex.size(); ++v)
            EXPECT_NEAR(made.attributes[1].values[v], (*made.positions)[v].z(), 1e-12);
        for (const double c : made.attributes[0].values) EXPECT_TRUE(c >= 0 && c <= 255);
    }
    options.attributes = false;
    EXPECT_TRUE(generate_grid_level(layer, options, session).layer->attributes.empty());
}

TEST(GridAttributes, FollowThoseOfTheControlMeshWhereTheyWereChanged) {
    const Layer layer = painted();
    GridLevelOptions options;
    options.level = 2;
    Session session;
    const DerivedMesh made = *generate_grid_level(layer, options, session).layer;
    Layer control = layer_of_level(made);
    control.attributes = made.attributes;
    for (double& x : control.attributes[0].values) x = std::round(x);  // as hosts keep colours
    GridEditOptions edit;
    edit.edited.place = 0, edit.attributes = true;
    const Result none = grid_edit({layer, {&control}}, edit, session);
    for (std::size_t a = 0; a < 3; ++a) EXPECT_EQ(none.attributes[a].values, layer.attributes[a].values);
    for (double& x : control.attributes[1].values) x += 5;
    for (std::size_t i = 2; i < control.attributes[0].values.size(); i += 4) control.attributes[0].values[i] += 30;
    const Result r = grid_edit({layer, {&control}}, edit, session);
    EXPECT_EQ(*r.positions, layer.mesh.positions);
    EXPECT_EQ(r.attributes[2].values, layer.attributes[2].values);
    for (std::size_t v = 0; v < layer.mesh.positions.size(); ++v) {
        EXPECT_NEAR(r.attributes[1].values[v], layer.attributes[1].values[v] + 5, 1e-5);  // kept as float
        EXPECT_NEAR(r.attributes[0].values[4 * v + 2], 70, 1e-9);
        EXPECT_EQ(r.attributes[0].values[4 * v], layer.attributes[0].values[4 * v]);
    }
}

}  // namespace multires
