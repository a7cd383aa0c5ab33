#include "filters/editing/transfer_detail.h"

#include "filter_fixtures.h"
#include "measure/distance.h"
#include "measure/measure.h"
#include "random.h"

#include <Eigen/Dense>

#include <functional>

// Detail from Layer: onto another mesh, into an attribute and back; the line query it asks the surface.

namespace multires {
namespace {

using fixtures::count;
using fixtures::largest_distance;
using fixtures::layer_of;
using fixtures::refusal;
using Similarity = fixtures::Motion;

TransferDetailOptions from_layer() {
    TransferDetailOptions o;
    o.layer.place = 0;
    o.largest_distance = 0.3;
    return o;
}

Result transfer(const Layer& layer, const Layer& other, const TransferDetailOptions& options = from_layer()) {
    Session session;
    return transfer_detail({layer, {&other}}, options, session);
}

/// A layer with what a result stored.
Layer with_stored(Layer layer, const Result& result) {
    layer.attributes = result.attributes;
    return layer;
}

Mesh bumpy_sphere(int vertices, double height) {
    Mesh mesh = shapes::irregular_sphere(vertices, {0.2, 0.3, 5});
    const std::vector<double> bumps = shapes::harmonic(mesh.positions, 12, 2);
    for (std::size_t v = 0; v < bumps.size(); ++v) mesh.positions[v] *= 1 + height * bumps[v];
    return mesh;
}

double rms_distance(const Positions& p, const Mesh& surface) {
    const SurfaceTree tree(surface.faces, surface.positions);
    double sum = 0;
    for (const Vec3& q : p) sum += tree.closest(q).squared;
    return std::sqrt(sum / static_cast<double>(p.size()));
}

}  // namespace

TEST(SurfaceTree, FindsTheNearestCrossingOfALine) {
    for (const Mesh& mesh : {shapes::scan(400, {0.2, 0.3, 5}), fixtures::random_soup(3), fixtures::random_soup(8)}) {
        const SurfaceTree tree(mesh.faces, mesh.positions);
        shapes::Random random(7);
        int met = 0;
        for (int i = 0; i < 500; ++i) {
            const Vec3 p = 0.8 * random.direction(), d = random.direction();
            const double within = random.uniform(0.1, 2);
            double nearest = std::numeric_limits<double>::infinity();
            for (const Face& f : mesh.faces) {  // by solving for the crossing
                const Vec3 &a = mesh.positions[f[0]], &b = mesh.positions[f[1]], &c = mesh.positions[f[2]];
                Eigen::Matrix3d m;
                m << b - a, c - a, -d;
                if (std::abs(m.determinant()) < 1e-12 || (b - a).cross(c - a).dot(d) < 0) continue;
                const Vec3 x = m.inverse() * (p - a);
                if (x[0] >= 0 && x[1] >= 0 && x[0] + x[1] <= 1 && std::abs(x[2]) <= within)
                    nearest = std::min(nearest, std::abs(x[2]));
            }
            const auto hit = tree.nearest_crossing(p, d, within);
            EXPECT_EQ(hit.face >= 0, std::isfinite(nearest));
            if (hit.face < 0) continue;
            EXPECT_NEAR(std::abs(hit.at), nearest, 1e-10);
            ++met;
        }
        EXPECT_GT(met, 20);
    }
}

TEST(TransferDetail, BringsTheDetailOfAScanOntoASmoothRemesh) {
    const Mesh scan = bumpy_sphere(8000, 0.01), smooth = shapes::irregular_sphere(6000, {0.3, 0.4, 9});
    const Result r = transfer(layer_of(smooth), layer_of(scan));
    EXPECT_EQ(count(r.report, "vertices_without"), 0);
    EXPECT_LT(rms_distance(*r.positions, scan), 1e-12);
    EXPECT_GT(rms_distance(smooth.positions, scan), 1e-3);
    // Half and twice of it; and what is left out by limits.
    TransferDetailOptions options = from_layer();
    for (options.gain = -1; options.gain <= 2; options.gain += 1) {
        const Positions p = *transfer(layer_of(smooth), layer_of(scan), options).positions;
        for (std::size_t v = 0; v < p.size(); ++v)
            EXPECT_LT((p[v] - smooth.positions[v] - options.gain * ((*r.positions)[v] - smooth.positions[v])).norm(),
                      1e-12);
    }
    options.gain = 1;
    const double wave = 2 * 3.14159265358979 / 12;
    const auto left = [&](double finest, double coarsest) {
        options.finest = finest, options.coarsest = coarsest;
        return displacement(smooth.positions, *transfer(layer_of(smooth), layer_of(scan), options).positions).rms /
               displacement(smooth.positions, *r.positions).rms;
    };
    EXPECT_GT(left(wave / 5, 5 * wave), 0.8);
    EXPECT_LT(left(5 * wave, 0), 0.2);
    EXPECT_LT(left(0, wave / 5), 0.2);
}

TEST(TransferDetail, OfALayerWithTheSameFacesGivesItOnEveryClassOfMesh) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        const double size = bounding_box(mesh.positions).diagonal();
        Mesh sculpted = mesh;
        shapes::Random random(4);
        for (Vec3& p : sculpted.positions) p += 0.02 * size * random.direction();
        const Positions after = *transfer(layer_of(mesh), layer_of(sculpted)).positions;
        std::vector<int> used(after.size(), 0);
        for (const Face& f : mesh.faces)
            if (!repeats_an_index(f))
                for (const Index v : f) used[v] = 1;
        for (std::size_t v = 0; v < after.size(); ++v)
            EXPECT_LT((after[v] - (used[v] ? sculpted : mesh).positions[v]).norm(), 1e-12 * size);
        // Nothing to bring.
        EXPECT_LT(largest_distance(*transfer(layer_of(mesh), layer_of(mesh)).positions, mesh.positions), 1e-13 * size);
    }
}

TEST(TransferDetail, StoredGivesTheSameAsAppliedAndTurnsWithTheLayer) {
    const Mesh scan = bumpy_sphere(4000, 0.01), smooth = shapes::irregular_sphere(3000, {0.3, 0.4, 9});
    Mesh sculpted = smooth;
    shapes::Random random(4);
    for (Vec3& p : sculpted.positions) p += 0.01 * random.direction();
    for (const Mesh& source : {scan, sculpted}) {
        TransferDetailOptions options = from_layer();
        const Positions applied = *transfer(layer_of(smooth), layer_of(source)).positions;
        options.use = DetailUse::store;
        options.attribute = "pores";
        const Result kept = transfer(layer_of(smooth), layer_of(source), options);
        ASSERT_EQ(kept.attributes.size(), 1U);
        EXPECT_FALSE(kept.positions);
        EXPECT_EQ(kept.attributes[0].name, "pores");
        options.use = DetailUse::stored;
        Layer layer = with_stored(layer_of(smooth), kept);
        EXPECT_LT(largest_distance(*transfer(layer, layer_of(scan), options).positions, applied), 1e-13);
        const Similarity motion;
        layer.mesh = motion(smooth);
        const Positions there = *transfer(layer, layer_of(scan), options).positions;
        for (std::size_t v = 0; v < there.size(); ++v) EXPECT_LT((there[v] - motion(applied[v])).norm(), 1e-12);
        options.attribute = "other";
        EXPECT_NE(refusal([&] { transfer(layer, layer, options); }).find("use: there is no attribute other"),
                  std::string::npos);
    }
}

TEST(TransferDetail, FillsWhereNothingIsMetAndFallsToZero) {
    const Mesh grid = shapes::plane(40, {0.2, 0, 1});
    Mesh half = shapes::plane(20, {0, 0, 1});
    for (Vec3& p : half.positions) p = Vec3(0.5 * p.x(), p.y(), 0.1);
    TransferDetailOptions options = from_layer();
    options.largest_distance = 0.15;
    const Result r = transfer(layer_of(grid), layer_of(half), options);
    EXPECT_GT(count(r.report, "vertices_without"), 500);
    for (std::size_t v = 0; v < grid.positions.size(); ++v) {
        const Vec3 &p = grid.positions[v], &q = (*r.positions)[v];
        if (p.x() < 0.499) {
            EXPECT_NEAR(q.z() - p.z(), 0.1, 1e-12);
        }
        if (p.x() > 0.95) {
            EXPECT_LT(q.z() - p.z(), 0.02);
        }
        EXPECT_GE(q.z() - p.z(), -1e-9);
    }
    options.largest_distance = 0.05;
    EXPECT_NE(refusal([&] { transfer(layer_of(grid), layer_of(half), options); }).find("largest_distance"),
              std::string::npos);
    for (Face& f : half.faces) std::swap(f[0], f[1]);  // looks to the other side
    options.largest_distance = 0.15;
    EXPECT_NE(refusal([&] { transfer(layer_of(grid), layer_of(half), options); }), "");
}

TEST(TransferDetail, HoldsBetweenLayersAsTheirTransformationsPlaceThem) {
    const Mesh scan = bumpy_sphere(2000, 0.01), smooth = shapes::irregular_sphere(1500, {0.3, 0.4, 9});
    const Positions expected = *transfer(layer_of(smooth), layer_of(scan)).positions;
    for (const double mirror : {1.0, -1.0}) {
        Eigen::Matrix4d place = Eigen::Matrix4d::Identity();
        place.topLeftCorner<3, 3>() = 2 * Similarity().rotation * Vec3(1, 1, mirror).asDiagonal();
        place.topRightCorner<3, 1>() = Vec3(3, 4, 5);
        Layer layer = layer_of(smooth), other = layer_of(scan);
        other.to_world = place;
        for (Vec3& p : other.mesh.positions) p = (place.inverse() * p.homogeneous()).head<3>();
        if (mirror < 0)
            for (Face& f : other.mesh.faces) std::swap(f[0], f[1]);  // outwards in its own coordinates
        EXPECT_LT(largest_distance(*transfer(layer, other).positions, expected), 1e-9);
    }
}

TEST(TransferDetail, ActsOnTheSelection) {
    const Mesh scan = bumpy_sphere(2000, 0.01);
    Layer layer = layer_of(shapes::irregular_sphere(1500, {0.3, 0.4, 9}));
    for (const Vec3& p : layer.mesh.positions) layer.selected_vertex.push_back(p.z() > 0);
    const Positions all = *transfer(layer, layer_of(scan)).positions;
    TransferDetailOptions options = from_layer();
    options.region.selected = true;
    const Positions some = *transfer(layer, layer_of(scan), options).positions;
    for (std::size_t v = 0; v < some.size(); ++v)
        EXPECT_EQ(some[v], layer.selected_vertex[v] ? all[v] : layer.mesh.positions[v]);
}

TEST(TransferDetail, SaysWhatDoesNotFit) {
    const Layer layer = layer_of(shapes::irregular_sphere(500)), scan = layer_of(bumpy_sphere(800, 0.01));
    Layer cloud = scan;
    cloud.mesh.faces.clear();
    const auto why = [&](const Layer& other, const std::function<void(TransferDetailOptions&)>& change) {
        TransferDetailOptions options = from_layer();
        change(options);
        return refusal([&] { transfer(layer, other, options); });
    };
    const auto nothing = [](TransferDetailOptions&) {};
    EXPECT_EQ(why(layer, nothing), "layer: it is the current layer itself; choose another one");
    EXPECT_EQ(why(cloud, nothing).find("layer: "), 0U);
    EXPECT_EQ(why(scan, [](auto& o) { o.gain = NAN; }), "gain must be a number");
    EXPECT_EQ(why(scan, [](auto& o) { o.finest = 2, o.coarsest = 1; }), "finest must be below coarsest");
    EXPECT_EQ(why(scan, [](auto& o) { o.attribute = "a b"; }), "attribute must be of letters, digits and _");
    EXPECT_EQ(why(scan, [](auto& o) { o.largest_distance = -1; }), "largest_distance must be a number, 0 or more");
}

}  // namespace multires
