#include "filters/layers/difference.h"

#include "filter_fixtures.h"
#include "measure/signed_distance.h"
#include "random.h"

#include <limits>

// Difference to Layer: known distances and signs, placing, the low pass, refusals.

namespace multires {
namespace {

using fixtures::layer_of;
using fixtures::number;

DifferenceOptions to_first() {
    DifferenceOptions o;
    o.layer.place = 0;
    return o;
}

Result difference(const Layer& layer, const Layer& reference, const DifferenceOptions& options = to_first()) {
    Session session;
    return difference_to_layer({layer, {&reference}}, options, session);
}

std::vector<double> quality(const Layer& layer, const Layer& reference) {
    return std::move(*difference(layer, reference).quality);
}

std::string refusal(const Layer& layer, const Layer& reference, const DifferenceOptions& options = to_first()) {
    return fixtures::refusal([&] { difference(layer, reference, options); });
}

Mesh scaled(Mesh mesh, double factor) {
    for (Vec3& p : mesh.positions) p *= factor;
    return mesh;
}

Mesh moved(Mesh mesh, const Vec3& by) {
    for (Vec3& p : mesh.positions) p += by;
    return mesh;
}

/// A rotation and a shift.
Eigen::Matrix4d placement() {
    Eigen::Affine3d t = Eigen::Affine3d::Identity();
    t.translate(Vec3(3, -1, 2)).rotate(Eigen::AngleAxisd(1.1, Vec3(0.3, -0.8, 0.5).normalized()));
    return t.matrix();
}

}  // namespace

TEST(SignedDistance, OfACubeIsThatOfTheFormulaOnBothSidesAndAtEdgesAndCorners) {
    Mesh cube;
    for (int i = 0; i < 8; ++i) cube.positions.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
    cube.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    Mesh soup;  // no face shares a vertex
    for (const Face& f : cube.faces) {
        const auto n = static_cast<Index>(soup.positions.size());
        for (const Index v : f) soup.positions.push_back(cube.positions[v]);
        soup.faces.push_back({n, n + 1, n + 2});
    }
    shapes::Random random(1);
    for (const Mesh* mesh : {&cube, &soup}) {
        const SignedDistance surface(mesh->faces, mesh->positions);
        for (int i = 0; i < 5000; ++i) {
            const Vec3 p(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
            const Vec3 q = p.cwiseAbs() - Vec3::Ones();
            const double expected = q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
            ASSERT_NEAR(surface.at(p).distance, expected, 1e-14) << p.transpose();
        }
    }
}

// A spike whose tip has an obtuse and an acute side: the sign of a face at the tip, or of a plain mean, is wrong there.
TEST(SignedDistance, IsPositiveOutsideEverySpike) {
    for (const double height : {0.2, 1.0, 30.0}) {
        Mesh spike;
        spike.positions = {{0, 0, height}, {1, 0, 0}, {-0.3, 0.1, 0}, {-0.2, -0.4, 0}, {0.9, -0.02, 0}};
        spike.faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {1, 4, 3}, {1, 3, 2}};
        const SignedDistance surface(spike.faces, spike.positions);
        shapes::Random random(2);
        for (int i = 0; i < 3000; ++i) {
            const Vec3 p = Vec3(0, 0, height) + random.direction() * random.uniform(0.001, 3);
            if (p.z() <= height) continue;  // above the tip all is outside
            ASSERT_GT(surface.at(p).distance, 0) << p.transpose() << ", height " << height;
        }
    }
}

/// Distance from the origin to the nearest plane of a face: what a sphere of radius 1 has when it is made of chords.
double inner_radius(const Mesh& sphere) {
    double least = std::numeric_limits<double>::infinity();
    for (const Face& f : sphere.faces) {
        const Vec3 &a = sphere.positions[f[0]], &b = sphere.positions[f[1]], &c = sphere.positions[f[2]];
        least = std::min(least, std::abs((b - a).cross(c - a).normalized().dot(a)));
    }
    return least;
}

TEST(Difference, OfConcentricSpheresIsTheDifferenceOfTheirRadii) {
    const Mesh inner = shapes::irregular_sphere(4000), outer = scaled(shapes::icosphere(40), 1.25);
    for (const double q : quality(layer_of(inner), layer_of(outer))) {
        EXPECT_GE(q, 1 - 1.25 - 1e-12);
        EXPECT_LE(q, 1 - inner_radius(outer) + 1e-12);
    }
    for (const double q : quality(layer_of(outer), layer_of(inner))) {
        EXPECT_GE(q, 1.25 - 1 - 1e-12);
        EXPECT_LE(q, 1.25 - inner_radius(inner) + 1e-12);
    }
}

TEST(Difference, OfAShiftedPlaneIsTheShiftWithItsSignAlsoBeyondTheBoundary) {
    const Layer plane = layer_of(shapes::plane(20));
    for (const double shift : {-0.3, 1e-9, 0.5}) {
        const Layer other = layer_of(moved(shapes::plane(13, {0.2, 0.3, 7}), {0, 0, shift}));
        const Result r = difference(other, plane);
        for (const double q : *r.quality) EXPECT_NEAR(q, shift, 1e-15);
        EXPECT_NEAR(number(r.report, "mean_difference"), shift, 1e-15);
        EXPECT_NEAR(number(r.report, "rms_difference"), std::abs(shift), 1e-15);
    }
    const Layer aside = layer_of(moved(shapes::plane(13), {5, 0, -0.3}));
    for (const double q : quality(aside, plane)) EXPECT_LE(q, -4);
}

TEST(Difference, OfTheSameVerticesIsExactlyZeroOnEveryClassOfMesh) {
    for (const auto& [name, mesh] : fixtures::every_class()) {
        SCOPED_TRACE(name);
        Layer layer = layer_of(mesh);
        layer.to_world = placement();
        const Layer same = layer;
        DifferenceOptions options = to_first();
        for (options.wavelength = 0; options.wavelength <= 1; options.wavelength += 1) {
            const Result r = difference(layer, same, options);
            if (name == "unreferenced_vertices") {  // which are away from the surface, and the low pass starts from one
                EXPECT_LE(number(r.report, "rms_difference"), options.wavelength * 1e-15);
                continue;
            }
            EXPECT_EQ(*r.quality, std::vector<double>(mesh.positions.size(), 0));
            EXPECT_EQ(number(r.report, "rms_difference"), 0);
            EXPECT_EQ(number(r.report, "share_beyond"), 0);
        }
    }
}

TEST(Difference, IsBetweenTheLayersAsTheirTransformationsPlaceThem) {
    const Layer plain = layer_of(shapes::scan(1000)), reference = layer_of(scaled(shapes::scan(2000), 1.1));
    const std::vector<double> expected = quality(plain, reference);
    Layer turned = plain, turned_reference = reference;
    turned.to_world = turned_reference.to_world = placement();
    const std::vector<double> together = quality(turned, turned_reference);
    // The same shape, its coordinates turned back: the transformation puts them where they were.
    Layer undone = plain;
    const Eigen::Matrix4d back = placement().inverse();
    for (Vec3& p : undone.mesh.positions) p = (back * p.homogeneous()).head<3>();
    undone.to_world = placement();
    const std::vector<double> one = quality(undone, reference);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_NEAR(together[i], expected[i], 1e-13);
        EXPECT_NEAR(one[i], expected[i], 1e-13);
    }
}

TEST(Difference, KeepsOutsideOutsideWhereATransformationMirrors) {
    Layer inner = layer_of(shapes::icosphere(5)), outer = layer_of(scaled(shapes::icosphere(5), 2));
    inner.to_world(0, 0) = outer.to_world(0, 0) = -1;
    for (const double q : quality(outer, inner)) EXPECT_GT(q, 0.9);
    for (const double q : quality(inner, outer)) EXPECT_LT(q, -0.9);
}

TEST(Difference, WithAWavelengthShowsTheCoarseDeformationWithoutTheNoise) {
    shapes::BandedSphereOptions fine;
    fine.high_amplitude = 0.01;
    fine.low_amplitude = 0.03;
    const shapes::BandedSphere sphere = shapes::banded_sphere(fine);
    Mesh round;
    round.positions = sphere.sphere, round.faces = sphere.mesh.faces;
    DifferenceOptions options = to_first();
    options.wavelength = 0.45;  // between 1.4 of the low and 0.16 of the high one
    const auto error = [&](const Result& r) {
        double sum = 0;
        for (std::size_t i = 0; i < r.quality->size(); ++i) sum += std::pow((*r.quality)[i] - sphere.low[i], 2);
        return std::sqrt(sum / static_cast<double>(r.quality->size()));
    };
    const double all = error(difference(layer_of(sphere.mesh), layer_of(round)));
    EXPECT_NEAR(all, 0.01, 0.001);
    EXPECT_LE(error(difference(layer_of(sphere.mesh), layer_of(round), options)), all / 3);
}

TEST(Difference, ReportsTheShareOfTheAreaBeyondTheTolerance) {
    // A plane with a step: a quarter of it lifted.
    Mesh lifted = shapes::plane(40, {0, 0, 1});
    for (Vec3& p : lifted.positions)
        if (p.x() < 0.5 && p.y() < 0.5) p.z() = 0.01;
    DifferenceOptions options = to_first();
    options.beyond = 0.005;
    const Result r = difference(layer_of(lifted), layer_of(shapes::plane(9)), options);
    EXPECT_NEAR(number(r.report, "share_beyond"), 0.25, 0.03);  // a strip of vertices at the step
    EXPECT_NEAR(number(r.report, "mean_difference"), 0.0025, 0.0003);
    EXPECT_DOUBLE_EQ(number(r.report, "largest_difference"), 0.01);
    EXPECT_DOUBLE_EQ(number(r.report, "smallest_difference"), 0);
    options.beyond = 0.02;
    EXPECT_EQ(number(difference(layer_of(lifted), layer_of(shapes::plane(9)), options).report, "share_beyond"), 0);
}

TEST(Difference, WhatNoDistanceCanBeMeasuredToIsRefusedByName) {
    const Layer sphere = layer_of(shapes::icosphere(4));
    Layer cloud = sphere, empty, broken = layer_of(shapes::not_finite(std::numeric_limits<double>::quiet_NaN()));
    cloud.mesh.faces = Faces();
    EXPECT_NE(refusal(sphere, empty).find("layer: "), std::string::npos);
    EXPECT_NE(refusal(sphere, cloud).find("layer: "), std::string::npos);
    EXPECT_NE(refusal(sphere, cloud).find("no faces"), std::string::npos) << refusal(sphere, cloud);
    EXPECT_NE(refusal(sphere, broken).find("layer: "), std::string::npos);
    EXPECT_NE(refusal(broken, sphere), "");
    EXPECT_EQ(refusal(sphere, sphere), "layer: it is the current layer itself; choose another one");
    EXPECT_EQ(refusal(sphere, sphere, DifferenceOptions()), "layer: there is no other layer");
    Layer flat = sphere;
    flat.to_world.setZero();
    EXPECT_EQ(refusal(sphere, flat), "the transformation of the other layer is not finite");
    DifferenceOptions options = to_first();
    options.wavelength = -1;
    EXPECT_EQ(refusal(sphere, cloud, options).find("layer: "), 0U);
    EXPECT_EQ(refusal(sphere, layer_of(shapes::icosphere(5)), options), "wavelength must be a number, 0 or more");
}

}  // namespace multires
