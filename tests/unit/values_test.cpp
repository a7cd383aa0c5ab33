#include "base/reduce.h"
#include "denoise/field_noise.h"
#include "denoise/total_variation.h"
#include "denoise/value_impulses.h"
#include "denoise/value_slopes.h"
#include "denoise/value_steps.h"
#include "measure/measure.h"
#include "mesh/cells.h"

#include "fixtures.h"

#include <cmath>
#include <set>

namespace multires {

using namespace fixtures;

namespace {

Neighbours neighbours_of(const Mesh& mesh) {
    return neighbours(mesh.faces, vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size())));
}

std::vector<double> distance(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> out;
    for (std::size_t i = 0; i < a.size(); ++i) out.push_back(std::abs(a[i] - b[i]));
    return out;
}

TEST(Cells, HoldEveryVertexOnceAndNoMoreThanTheyMay) {
    const Mesh mesh = shapes::irregular_sphere(1000);
    std::set<Index> seen;
    std::size_t least = mesh.positions.size();
    for (const std::vector<Index>& cell : cells_of(mesh.positions, 100)) {
        EXPECT_LE(cell.size(), 100u);
        EXPECT_TRUE(std::is_sorted(cell.begin(), cell.end()));
        seen.insert(cell.begin(), cell.end());
        least = std::min(least, cell.size());
    }
    EXPECT_EQ(seen.size(), mesh.positions.size());
    EXPECT_GE(least, 50u);
    EXPECT_TRUE(cells_of({}, 10).empty());
    EXPECT_EQ(cells_of(Positions(7, Vec3(1, 1, 1)), 2).size(), 4u);  // all in one place
}

// One triangle, whose minimum is known: a value away from two others that are alike goes 2 strength towards them, which
// go half as far, until they meet.
TEST(TotalVariation, IsTheMinimumOnATriangle) {
    const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const Neighbours near = neighbours_of(mesh);
    const TotalVariation variation(near);
    const std::vector<double> y = {3, 0, 0}, same(3, 1);
    const std::vector<double> x = variation.denoised(y, 1, same, 0.4);
    EXPECT_NEAR(x[0], 2.2, 1e-3);
    EXPECT_NEAR(x[1], 0.4, 1e-3);
    EXPECT_NEAR(x[2], 0.4, 1e-3);
    for (const double met : variation.denoised(y, 1, same, 5)) EXPECT_NEAR(met, 1, 1e-2);
    EXPECT_EQ(variation.denoised(y, 1, same, 0), y);
    EXPECT_EQ(variation.denoised(y, 1, std::vector<double>(3, 0), 1), y);
    // Where there is no noise values stay, and pull the others.
    const std::vector<double> held = variation.denoised(y, 1, {0, 1, 1}, 0.4);
    EXPECT_EQ(held[0], 3);
    EXPECT_GT(held[1], 0.4);
}

TEST(TotalVariation, TurnsWithVectorsOfValues) {
    const Mesh mesh = shapes::irregular_sphere(500);
    const Neighbours near = neighbours_of(mesh);
    const TotalVariation variation(near);
    std::vector<double> values, turned;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const double a = gaussian(static_cast<Index>(i), 1), b = gaussian(static_cast<Index>(i), 2);
        values.insert(values.end(), {a, b});
        turned.insert(turned.end(), {0.6 * a - 0.8 * b, 0.8 * a + 0.6 * b});
    }
    const std::vector<double> same(mesh.positions.size(), 1), x = variation.denoised(values, 2, same, 0.5),
                                                              y = variation.denoised(turned, 2, same, 0.5);
    for (std::size_t i = 0; i < x.size(); i += 2) {
        EXPECT_NEAR(y[i], 0.6 * x[i] - 0.8 * x[i + 1], 1e-9);
        EXPECT_NEAR(y[i + 1], 0.8 * x[i] + 0.6 * x[i + 1], 1e-9);
    }
}

TEST(TotalVariation, DenoisesTwoFieldsSideBySideAsEachByItself) {
    const Mesh mesh = shapes::irregular_sphere(500);
    const Neighbours near = neighbours_of(mesh);
    const TotalVariation variation(near);
    const std::size_t count = mesh.positions.size();
    const std::vector<double> same(count, 1);
    for (const std::size_t width : {1, 2, 3, 4}) {
        std::vector<double> both(2 * width * count);
        for (std::size_t i = 0; i < both.size(); ++i) both[i] = gaussian(static_cast<Index>(i), 3);
        const auto field = [&](const std::vector<double>& all, std::size_t which) {
            std::vector<double> out;
            for (std::size_t i = 0; i < all.size(); ++i)
                if (i / width % 2 == which) out.push_back(all[i]);
            return out;
        };
        const std::vector<double> after = variation.denoised(both, static_cast<int>(width), same, 0.5);
        for (const std::size_t which : {0, 1})
            EXPECT_EQ(field(after, which), variation.denoised(field(both, which), static_cast<int>(width), same, 0.5));
    }
}

TEST(ValueSlopes, AreThoseOfThePlaneWhateverAFewValuesAre) {
    const Mesh mesh = shapes::irregular_sphere(4000);
    const ValueSurface surface(mesh);
    std::vector<double> values;
    for (const Vec3& p : mesh.positions) values.insert(values.end(), {3 * p.x() - p.z() + 5, 1});
    for (std::size_t i = 0; i < values.size(); i += 22) values[i] += 50;
    const std::vector<Vec3> slope = value_slopes(surface.near, mesh.positions, surface.normal, values, 2);
    Mean off;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3 n = surface.normal[static_cast<Index>(i)], g(3, 0, -1);
        off.add((slope[2 * i] - (g - g.dot(n) * n)).norm());
        EXPECT_EQ(slope[2 * i + 1], Vec3(0, 0, 0));
    }
    EXPECT_LT(off.value(), 0.1);                                          // the sphere bends
    const Mesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};  // too small to tell
    const ValueSurface small(triangle);
    EXPECT_EQ(value_slopes(small.near, triangle.positions, small.normal, {0, 1, 2}, 1),
              std::vector<Vec3>(3, Vec3(0, 0, 0)));
}

TEST(ValueImpulses, AreFoundOnPlainSteepAndWavyValues) {
    const Mesh mesh = shapes::irregular_sphere(4000);
    const ValueSurface surface(mesh);
    std::vector<double> plain, steep, wavy;
    for (const Vec3& p : mesh.positions) {
        plain.push_back(2);
        steep.push_back(60 * p.x());  // three from vertex to vertex
        wavy.push_back(8 * std::sin(8 * p.x()));
    }
    for (const std::vector<double>& truth : {plain, steep, wavy}) {
        std::vector<double> values = truth;
        std::size_t hit = 0;
        for (std::size_t i = 0; i < values.size(); ++i)
            if (i % 37 == 0) values[i] += i % 2 == 0 ? 7 : -7, ++hit;
        const ValueImpulses found = without_impulses(surface, values, 1);
        EXPECT_NEAR(static_cast<double>(found.count), static_cast<double>(hit), 0.1 * static_cast<double>(hit));
        const std::vector<double> error = distance(found.values, truth);
        EXPECT_LT(std::accumulate(error.begin(), error.end(), 0.0), 0.2 * 7 * static_cast<double>(hit));
    }
}

// A few, on a shape most of which bends nowhere: what they have around them is chance.
TEST(ValueImpulses, AreFoundWhereTheyAreFew) {
    const Mesh mesh = shapes::block(14);
    const ValueSurface surface(mesh);
    for (int seed = 0; seed < 20; ++seed) {
        std::vector<double> values(mesh.positions.size(), 1);
        shapes::Random random(seed);
        std::size_t hit = 0;
        for (double& x : values)
            if (random.uniform(0, 1) < 0.013) x = 2, ++hit;
        EXPECT_NEAR(static_cast<double>(without_impulses(surface, values, 1).count), static_cast<double>(hit), 4)
            << seed;
    }
}

// One in seven, so that most have others beside them.
TEST(ValueImpulses, AreFoundBesideEachOther) {
    const Mesh mesh = shapes::irregular_sphere(4000);
    const ValueSurface surface(mesh);
    std::vector<double> truth, values;
    shapes::Random random(3);
    for (const Vec3& p : mesh.positions) {
        truth.push_back(p.x());
        values.push_back(random.uniform(0, 1) < 0.14 ? random.uniform(0, 1) < 0.5 ? -5 : 5 : p.x());
    }
    const ValueImpulses found = without_impulses(surface, values, 1);
    EXPECT_LT(rms(distance(found.values, truth)), 0.2 * rms(distance(values, truth)));
}

TEST(ValueImpulses, AreNotFoundAmongNoiseTexturePatternsAndWhatBelongsToTheMesh) {
    const Mesh mesh = shapes::irregular_sphere(4000);
    ValueSurface surface(mesh);
    std::fill(surface.bend.begin(), surface.bend.end(), 1);
    std::vector<double> noise, texture, checker, dotted, extremes, valence;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3& p = mesh.positions[i];
        noise.push_back(gaussian(static_cast<Index>(i), 1));
        texture.push_back(std::sin(40 * p.x()) * std::sin(40 * p.y()));
        checker.push_back(std::sin(25 * p.x()) * std::sin(25 * p.y()) > 0 ? 1 : 0);
        dotted.push_back(std::abs(p.z()) < 0.03 && i % 2 == 0 ? 1 : 0);
        extremes.push_back(i % 50 == 0 ? 1 : 0);
        if (i % 50 == 0) surface.bend[i] = 3;
        valence.push_back(surface.near.size(static_cast<Index>(i)) > 7 ? 1 : 0);
    }
    for (const std::vector<double>& values : {noise, texture, checker, dotted, extremes, valence}) {
        const ValueImpulses found = without_impulses(surface, values, 1);
        EXPECT_EQ(found.count, 0u);
        EXPECT_EQ(found.values, values);
    }
}

TEST(RoundingStep, IsFoundOnContoursOnly) {
    const Mesh mesh = shapes::irregular_sphere(4000);
    const Neighbours near = neighbours_of(mesh);
    std::vector<double> contours, labels, smooth, noise;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const double x = mesh.positions[i].x();
        smooth.push_back(x);
        contours.push_back(0.17 * std::round(x / 0.17) + 0.03);
        labels.push_back(std::fmod(3 * std::round(5 * x) + 100, 11));
        noise.push_back(std::round(3 * gaussian(static_cast<Index>(i), 1)));
    }
    EXPECT_NEAR(rounding_step(near, contours), 0.17, 1e-12);
    for (const std::vector<double>& values : {smooth, labels, noise, std::vector<double>(smooth.size(), 3)})
        EXPECT_EQ(rounding_step(near, values), 0);
    const std::vector<double> after = within_steps(near, contours, 0.17), moved = distance(after, contours);
    EXPECT_LE(*std::max_element(moved.begin(), moved.end()), 0.085 + 1e-12);
}

TEST(LocalFieldNoise, IsThatOfTheVertexWhereItVaries) {
    const Mesh mesh = shapes::irregular_sphere(12000);
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()));
    const Neighbours near = neighbours(mesh.faces, at);
    const std::vector<double> weight = cotangent_weights(mesh.faces, at, near, mesh.positions);
    std::vector<double> varying, even;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3& p = mesh.positions[i];
        const double noise = gaussian(static_cast<Index>(i), 1), shape = 5 * p.x() * p.y();
        varying.push_back(shape + (0.3 + 0.2 * p.z()) * noise);
        even.push_back(shape + 0.3 * noise);
    }
    const std::vector<double> found = local_field_noise(near, weight, mesh.positions, varying),
                              same = local_field_noise(near, weight, mesh.positions, even);
    double squares = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
        squares += std::pow(found[i] / (0.3 + 0.2 * mesh.positions[i].z()) - 1, 2) / static_cast<double>(found.size());
    EXPECT_LT(std::sqrt(squares), 0.15);
    EXPECT_EQ(*std::min_element(same.begin(), same.end()), *std::max_element(same.begin(), same.end()));
    EXPECT_NEAR(same[0], 0.3, 0.02);
}

}  // namespace
}  // namespace multires
