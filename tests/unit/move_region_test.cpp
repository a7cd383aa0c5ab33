#include "filters/editing/move_region.h"

#include "editing/falloff.h"
#include "filter_fixtures.h"
#include "measure/measure.h"

#include <functional>

// Move Region and the falloff between two regions.

namespace multires {
namespace {

using fixtures::layer_of;

Result move(const Layer& layer, const MoveRegionOptions& options) {
    Session session;
    return move_region(layer, options, session);
}

/// A layer with the vertices selected that `inside` says.
Layer selected(Mesh mesh, const std::function<bool(const Vec3&)>& inside) {
    Layer layer = layer_of(std::move(mesh));
    for (const Vec3& p : layer.mesh.positions) layer.selected_vertex.push_back(inside(p));
    return layer;
}

Layer bumpy_head() {
    return selected(shapes::scan(8000, {0.2, 0.3, 5}), [](const Vec3& p) { return p.z() > 0.8; });
}

}  // namespace

TEST(Falloff, OfAStripIsTheCosineAcrossIt) {
    const Mesh grid = shapes::plane(40, {0, 0, 1});
    std::vector<std::uint8_t> inside;
    for (const Vec3& p : grid.positions) inside.push_back(p.x() < 0.26);
    const std::vector<double> theta = falloff(grid, inside, 0.5, {});
    for (std::size_t v = 0; v < theta.size(); ++v) {
        const double s = std::clamp((0.75 - grid.positions[v].x()) / 0.5, 0.0, 1.0);  // columns of 1/40
        EXPECT_NEAR(theta[v], 0.5 - 0.5 * std::cos(3.14159265358979 * s), 1e-8) << grid.positions[v].transpose();
    }
}

TEST(Falloff, IsOneInsideZeroBeyondAndBetweenThemElsewhereOnEveryClassOfMesh) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        const double size = bounding_box(mesh.positions).diagonal();
        std::vector<std::uint8_t> inside(mesh.positions.size(), 0);
        for (const Index v : mesh.faces.front()) inside[v] = 1;
        for (const double distance : {0.0, 0.2 * size, 10 * size}) {
            const std::vector<double> theta = falloff(mesh, inside, distance, {});
            for (std::size_t v = 0; v < theta.size(); ++v) {
                EXPECT_GE(theta[v], 0);
                EXPECT_LE(theta[v], 1);
                if (inside[v]) {
                    EXPECT_EQ(theta[v], 1);
                } else if ((mesh.positions[v] - mesh.positions[mesh.faces.front()[0]]).norm() > 2 * size ||
                           distance == 0) {
                    EXPECT_EQ(theta[v], 0);
                }
            }
        }
    }
}

TEST(MoveRegion, WithoutAMotionIsTheSameBitForBitOnEveryClassOfMesh) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        Layer layer = layer_of(mesh);
        layer.selected_face.assign(mesh.faces.size(), 0);
        layer.selected_face.front() = 1;
        MoveRegionOptions options;
        options.pivot = {7, 8, 9};
        options.between.falloff = 0.3;
        EXPECT_EQ(*move(layer, options).positions, mesh.positions);
    }
}

TEST(MoveRegion, MovesTheRegionAsARigidBodyAndNothingBeyondTheFalloff) {
    const Layer layer = bumpy_head();
    MoveRegionOptions options;
    options.between.falloff = 0.5;
    options.pivot = {0.1, 0, 0.6};
    options.axis = Vec3(1, 2, 0).normalized();
    options.angle = 50;
    options.scale = 1.3;
    options.translation = {0.1, 0.2, 0.3};
    const Eigen::AngleAxisd turn(50 * 3.14159265358979323846 / 180, options.axis);
    for (options.details_follow = false;; options.details_follow = true) {
        options.store_falloff = true;
        const Result r = move(layer, options);
        int between = 0;
        for (std::size_t v = 0; v < layer.mesh.positions.size(); ++v) {
            const Vec3& p = layer.mesh.positions[v];
            const Vec3 rigid = options.pivot + 1.3 * (turn * (p - options.pivot)) + options.translation;
            if (layer.selected_vertex[v]) {
                EXPECT_LT(((*r.positions)[v] - rigid).norm(), 1e-14);
            }
            if ((*r.quality)[v] == 0) {
                EXPECT_EQ((*r.positions)[v], p);
            }
            between += (*r.quality)[v] > 0 && (*r.quality)[v] < 1;
        }
        EXPECT_GT(between, 500);
        if (options.details_follow) break;
    }
}

TEST(MoveRegion, WithoutASelectionSaysWhatToSelect) {
    const Layer layer = layer_of(shapes::scan(1000));
    MoveRegionOptions options;
    EXPECT_EQ(*move(layer, options).positions, layer.mesh.positions);
    options.translation = {1, 0, 0};
    try {
        move(layer, options);
        FAIL();
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("select the vertices or faces"), std::string::npos);
    }
}

// A plane with bumps, one side of it lifted: bumps that follow stand upright on the slope.
TEST(MoveRegion, DetailsThatFollowStayPerpendicularToTheSurface) {
    Mesh grid = shapes::plane(120, {0, 0, 1});
    const Mesh flat = grid;
    const auto bump = [](const Vec3& p) { return 0.004 * std::sin(120 * p.x()) * std::sin(120 * p.y()); };
    for (Vec3& p : grid.positions) p.z() = bump(p);
    const auto inside = [](const Vec3& p) { return p.x() > 0.8; };
    MoveRegionOptions options;
    options.between.falloff = 0.5;
    options.translation = {0, 0, 0.4};
    const auto error = [&](bool follow) {
        options.details_follow = follow;
        const Positions bent = *move(selected(flat, inside), options).positions;
        const Positions after = *move(selected(grid, inside), options).positions;
        const Array<Vec3> normals = face_normals(flat.faces, bent);
        double sum = 0;
        for (std::size_t f = 0; f < flat.faces.size(); ++f)
            for (const Index v : flat.faces[f])
                sum += (after[v] - bent[v] - bump(flat.positions[v]) * normals[f]).squaredNorm();
        return std::sqrt(sum / static_cast<double>(3 * flat.faces.size()));
    };
    EXPECT_LT(error(true), 0.6 * error(false));
}

TEST(MoveRegion, RefusesWhatIsNoMotion) {
    const Layer layer = bumpy_head();
    const auto refused = [&](const std::function<void(MoveRegionOptions&)>& change) {
        MoveRegionOptions options;
        change(options);
        EXPECT_THROW(move(layer, options), InputError);
    };
    refused([](MoveRegionOptions& o) { o.scale = 0; });
    refused([](MoveRegionOptions& o) { o.between.falloff = -1; });
    refused([](MoveRegionOptions& o) { o.angle = std::numeric_limits<double>::quiet_NaN(); });
    refused([](MoveRegionOptions& o) { o.translation.x() = std::numeric_limits<double>::infinity(); });
}

}  // namespace multires
