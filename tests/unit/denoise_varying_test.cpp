#include "denoise/noise_classes.h"
#include "denoise/varying_noise.h"
#include "filters/shape/denoise.h"
#include "measure/vertex_normals.h"

#include "denoise_fixtures.h"
#include "reported.h"

namespace multires {

using namespace fixtures;

namespace {

/// A mesh with noise of another deviation at each vertex.
struct Varying {
    Mesh mesh;
    std::vector<double> deviation;  ///< #V, mesh units

    /// @param least, most  at the two ends, edge lengths
    /// @param at_once      it changes in the middle, otherwise by and by
    Varying(const Mesh& truth, double least, double most, bool at_once, NoiseKind kind = NoiseKind::along_normals)
        : mesh(truth) {
        const double edge = mean_edge_length(truth.faces, truth.positions);
        const Array<Vec3> normal = multires::vertex_normals(truth.faces, truth.positions);
        double low = truth.positions[0].x(), high = low;
        for (const Vec3& p : truth.positions) low = std::min(low, p.x()), high = std::max(high, p.x());
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const double along = (truth.positions[i].x() - low) / (high - low);
            const double share = at_once ? (along < 0.5 ? 0 : 1) : along;
            deviation.push_back(edge * (least + (most - least) * share));
            const auto random = [&](std::uint64_t seed) { return gaussian(static_cast<Index>(i), seed); };
            mesh.positions[i] +=
                deviation.back() * (kind == NoiseKind::along_normals ? Vec3(random(44) * normal[i])
                                                                     : Vec3(random(44), random(45), random(46)));
        }
    }
};

TEST(VaryingNoise, IsFollowedByDenoise) {
    for (const Mesh& truth : {shapes::irregular_sphere(15000), shapes::block(25)})
        for (const bool at_once : {true, false}) {
            Layer layer;
            layer.mesh = Varying(truth, 0.05, 0.3, at_once).mesh;
            Session session;
            const Result result = denoise(layer, {}, session);
            const Error before = error_of(truth, layer.mesh.positions), after = error_of(truth, *result.positions);
            EXPECT_LT(after.angle, 0.35 * before.angle);
            EXPECT_LT(after.rms, 0.55 * before.rms);
            const double edge = mean_edge_length(truth.faces, truth.positions);
            EXPECT_LT(reported<double>(result, "noise_least"), 0.1 * edge);
            EXPECT_GT(reported<double>(result, "noise_most"), 0.22 * edge);
        }
}

TEST(VaryingNoise, IsFollowedWithinTheSurfaceToo) {
    for (const Mesh& truth : {shapes::irregular_sphere(10000), shapes::torus(120, 60)}) {
        Layer layer;
        layer.mesh = Varying(truth, 0.1, 0.4, false, NoiseKind::all_directions).mesh;
        Session session;
        const Result result = denoise(layer, {}, session);
        EXPECT_TRUE(reported<bool>(result, "noise_in_all_directions"));
        const Error before = error_of(truth, layer.mesh.positions), after = error_of(truth, *result.positions);
        EXPECT_LT(after.angle, 0.35 * before.angle);
        EXPECT_LT(after.rms, 0.9 * before.rms);
    }
}

TEST(VaryingNoise, IsKnownAtEachVertexAndNotSeenWhereItIsTheSame) {
    const Mesh truth = shapes::irregular_sphere(12000);
    const Incidence at = vertex_faces(truth.faces, static_cast<Index>(truth.positions.size()));
    const Neighbours near = neighbours(truth.faces, at);
    const Varying noisy(truth, 0.05, 0.3, false);
    const std::vector<double> found = varying_noise(truth.faces, noisy.mesh.positions, at, near);
    ASSERT_EQ(found.size(), noisy.deviation.size());
    double squares = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
        squares += std::pow(found[i] / noisy.deviation[i] - 1, 2) / static_cast<double>(found.size());
    EXPECT_LT(std::sqrt(squares), 0.15);
    for (const NoiseKind kind : {NoiseKind::along_normals, NoiseKind::all_directions, NoiseKind::impulsive})
        EXPECT_TRUE(varying_noise(truth.faces, with_noise(truth, 0.2, kind, 1), at, near).empty());
    EXPECT_TRUE(varying_noise(truth.faces, truth.positions, at, near).empty());
}

TEST(NoiseClasses, PassIntoEachOther) {
    const NoiseClasses same(std::vector<double>(100, 0.3)), none({});
    EXPECT_EQ(same.count(), 1u);
    EXPECT_EQ(none.count(), 1u);
    EXPECT_EQ(same.shares(7)[0], 1);
    std::vector<double> deviation;
    for (int i = 0; i <= 100; ++i) deviation.push_back(std::exp(0.02 * i));
    const NoiseClasses classes(deviation);
    ASSERT_EQ(classes.count(), 3u);
    for (double d = 0.5; d < 10; d *= 1.01) {
        const std::array<double, 3> now = classes.shares(d), next = classes.shares(1.01 * d);
        EXPECT_NEAR(now[0] + now[1] + now[2], 1, 1e-12);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(now[c], next[c], 0.02);
    }
    EXPECT_EQ(classes.shares(1)[0], 1);
    EXPECT_EQ(classes.shares(9)[2], 1);
    EXPECT_NEAR(classes.shares(std::exp(1.0))[1], 1, 1e-9);
}

}  // namespace
}  // namespace multires
