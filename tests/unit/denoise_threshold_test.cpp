#include "filters/shape/denoise_threshold.h"

#include "denoise_fixtures.h"
#include "measure/vertex_normals.h"
#include "scheme_fixtures.h"

namespace multires {

using namespace fixtures;

namespace {

Mesh noisy_scan(double deviation) {
    Mesh mesh = shapes::scan(2000);
    mesh.positions = with_noise(mesh, deviation);
    return mesh;
}

/// The schemes, with and without presmoothing, and both rules.
std::vector<DenoiseOptions> every_way() {
    std::vector<DenoiseOptions> all;
    for (const int scheme : fixtures::every_scheme())
        for (const double presmooth : {0.0, 0.5})
            for (const DenoiseMethod method : {DenoiseMethod::soft_threshold, DenoiseMethod::hard_threshold}) {
                DenoiseOptions o;
                o.method = method;
                o.pyramid.scheme.row = scheme;
                o.pyramid.scheme.presmooth = presmooth;
                all.push_back(o);
            }
    return all;
}

Report report_of(const Mesh& mesh, const DenoiseOptions& options) {
    Session session;
    return denoise(layer_of(mesh), options, session).report;
}

}  // namespace

TEST(DenoiseThreshold, ZeroGivesTheInputBack) {
    const Mesh mesh = noisy_scan(0.2);
    for (DenoiseOptions options : every_way()) {
        options.unit = ThresholdUnit::length;
        options.threshold = 0;
        EXPECT_LE(largest_distance(denoised(mesh, options), mesh.positions), 1e-12);
        for (const double share : series(report_of(mesh, options), "share_zeroed")) EXPECT_EQ(share, 0);
    }
}

TEST(DenoiseThreshold, AShareOfTheDetailsGoes) {
    const Mesh mesh = noisy_scan(0.2);
    for (DenoiseOptions options : every_way()) {
        options.unit = ThresholdUnit::share;
        options.coarsest_level = options.finest_level + 1;  // the report gives shares by level
        options.threshold = 0;
        EXPECT_LE(largest_distance(denoised(mesh, options), mesh.positions), 1e-12);
        for (const double percent : {20.0, 50.0, 100.0}) {
            options.threshold = percent;
            // of 920 details or more, up to one
            EXPECT_NEAR(series(report_of(mesh, options), "share_zeroed")[0], percent / 100, 1.1 / 920);
        }
        options.threshold = 101;
        EXPECT_THROW(denoised(mesh, options), InputError);
    }
    DenoiseOptions other;
    other.unit = ThresholdUnit::share;
    EXPECT_THROW(denoised(mesh, other), InputError);
}

TEST(DenoiseThreshold, AHugeOneRemovesTheLevels) {
    const Mesh mesh = noisy_scan(0.2);
    for (DenoiseOptions options : every_way()) {
        options.unit = ThresholdUnit::length;
        options.threshold = 1e6;
        options.finest_level = 1;
        options.coarsest_level = 4;
        BandOptions band;
        band.pyramid = options.pyramid;
        band.band = {Unit::level, 1, 4, 0};
        band.gain = 0;
        Session session;
        EXPECT_LE(largest_distance(denoised(mesh, options), *scale_band(layer_of(mesh), band, session).positions),
                  1e-12);
        EXPECT_EQ(series(report_of(mesh, options), "share_zeroed"), (std::vector<double>{1, 1, 1}));
    }
}

TEST(DenoiseThreshold, LevelsBeyondTheBaseDoNotMatter) {
    const Mesh mesh = noisy_scan(0.1);
    DenoiseOptions options;
    options.method = DenoiseMethod::soft_threshold;
    options.coarsest_level = 1000;
    EXPECT_LT(series(report_of(mesh, options), "share_zeroed").size(), 100u);
    options.finest_level = 999;
    EXPECT_LE(largest_distance(denoised(mesh, options), mesh.positions), 1e-12);
}

TEST(DenoiseThreshold, RemovesNoise) {
    const Mesh truth = shapes::irregular_sphere(4000);
    Mesh mesh = truth;
    mesh.positions = with_noise(truth, 0.2);
    const Error before = error_of(truth, mesh.positions);
    for (const DenoiseOptions& options : every_way()) {
        const Error after = error_of(truth, denoised(mesh, options));
        EXPECT_LT(after.angle, 0.6 * before.angle);
        EXPECT_LT(after.rms, before.rms);
    }
}

// It was not seen at all, and stayed.
TEST(DenoiseThreshold, RemovesNoiseAlongAnAxis) {
    const Mesh truth = shapes::irregular_sphere(4000);
    Mesh mesh = truth;
    const double size = 0.2 * mean_edge_length(truth.faces, truth.positions);
    shapes::Random random(1);
    for (Vec3& p : mesh.positions) p.z() += size * gaussian(random);
    const Error before = error_of(truth, mesh.positions);
    for (const DenoiseOptions& options : every_way()) {
        const Error after = error_of(truth, denoised(mesh, options));
        EXPECT_LT(after.angle, 0.75 * before.angle);
        EXPECT_LT(after.rms, before.rms);
    }
}

// Soft thresholding left a scan with noise of a tenth of an edge length half as far again from the truth as it was.
TEST(DenoiseThreshold, NeverHarms) {
    const std::vector<std::pair<std::string, Mesh>> truths = {{"sphere", shapes::irregular_sphere(1000)},
                                                              {"scan", shapes::scan(1000)},
                                                              {"block", shapes::block(16)},
                                                              {"torus", shapes::torus(48, 24)}};
    std::size_t turn = 0;  // each case takes a quarter of the ways, for time
    for (const auto& [name, truth] : truths)
        for (const NoiseKind kind : {NoiseKind::along_normals, NoiseKind::all_directions, NoiseKind::impulsive})
            for (const double deviation : {0.02, 0.1, 0.5}) {
                Mesh mesh = truth;
                mesh.positions = with_noise(truth, deviation, kind);
                const double before = displacement(truth.positions, mesh.positions).rms;
                const double angle = mean_normal_angle(truth.faces, truth.positions, mesh.positions);
                const std::vector<DenoiseOptions> ways = every_way();
                for (std::size_t way = turn++ % 4; way < ways.size(); way += 4) {
                    const DenoiseOptions& options = ways[way];
                    const Positions after = denoised(mesh, options);
                    SCOPED_TRACE(name + ", noise " + std::to_string(deviation) + " of kind " +
                                 std::to_string(static_cast<int>(kind)) + ", scheme " +
                                 std::to_string(options.pyramid.scheme.row) + ", presmooth " +
                                 std::to_string(options.pyramid.scheme.presmooth) + ", method " +
                                 std::to_string(static_cast<int>(options.method)));
                    EXPECT_LE(displacement(truth.positions, after).rms, 1.005 * before);
                    EXPECT_LE(mean_normal_angle(truth.faces, truth.positions, after), 1.005 * angle);
                }
            }
}

// Its roughness was taken for noise, so that the distance grew to more than twice that of the noise.
TEST(DenoiseThreshold, KeepsARoughSurface) {
    const Mesh truth = rough_terrain(54);
    Mesh mesh = truth;
    mesh.positions = with_noise(truth, 0.03);
    const double before = displacement(truth.positions, mesh.positions).rms;
    for (const DenoiseOptions& options : every_way())
        EXPECT_LE(displacement(truth.positions, denoised(mesh, options)).rms, 1.005 * before);
}

TEST(DenoiseThreshold, LeavesWhatHasNoNoise) {
    for (const auto& [name, mesh] : every_class())
        for (const DenoiseOptions& options : every_way())
            EXPECT_LE(displacement(mesh.positions, denoised(mesh, options)).rms,
                      0.02 * mean_edge_length(mesh.faces, mesh.positions) + 1e-300)
                << name;
}

TEST(DenoiseThreshold, OneThresholdForAllLevelsIsTheSameForAll) {
    const Mesh mesh = noisy_scan(0.2);
    DenoiseOptions options;
    options.method = DenoiseMethod::soft_threshold;
    const auto each = series(report_of(mesh, options), "threshold_per_level");
    options.per_level = false;
    const auto one = series(report_of(mesh, options), "threshold_per_level");
    ASSERT_EQ(one.size(), 5u);
    EXPECT_GT(one[0], 0);
    for (const double t : one) EXPECT_EQ(t, one[0]);
    EXPECT_NE(each[4], each[0]);
    options.strength = 2;
    EXPECT_NEAR(series(report_of(mesh, options), "threshold_per_level")[0], 2 * one[0], 1e-15);
}

TEST(DenoiseThreshold, AlongTheNormalOnlyLeavesWhatIsInTheSurface) {
    // A plane whose vertices and outline are in waves: all details are within it.
    Mesh plane = shapes::plane(25);
    const Face& f = plane.faces[0];
    const Vec3 along = (plane.positions[f[1]] - plane.positions[f[0]]).normalized();
    const Vec3 across = area_vector(f, plane.positions).normalized().cross(along);
    for (Vec3& p : plane.positions) p += 0.05 * std::sin(9 * p.dot(along)) * across;
    for (DenoiseOptions options : every_way()) {
        options.unit = ThresholdUnit::length;
        options.threshold = 1;
        EXPECT_GT(largest_distance(denoised(plane, options), plane.positions), 1e-3);
        options.normal_only = true;
        EXPECT_LE(largest_distance(denoised(plane, options), plane.positions), 1e-12);
    }
    // Noise along the normals goes all the same.
    const Mesh truth = shapes::irregular_sphere(3000);
    Mesh mesh = truth;
    mesh.positions = with_noise(truth, 0.2);
    DenoiseOptions options;
    options.method = DenoiseMethod::soft_threshold;
    options.normal_only = true;
    EXPECT_LT(error_of(truth, denoised(mesh, options)).angle, 0.5 * error_of(truth, mesh.positions).angle);
}

TEST(DenoiseThreshold, CycleSpinningAveragesHierarchies) {
    const Mesh truth = shapes::irregular_sphere(3000);
    Mesh mesh = truth;
    mesh.positions = with_noise(truth, 0.2);
    DenoiseOptions options;
    options.method = DenoiseMethod::hard_threshold;
    double last = 1e300;
    for (const int spins : {1, 2, 8}) {
        options.cycle_spins = spins;
        const double angle = error_of(truth, denoised(mesh, options)).angle;
        EXPECT_LT(angle, last);
        last = angle;
    }
}

TEST(DenoiseThreshold, KeepsThePyramidForTheNextCall) {
    const Layer layer = layer_of(noisy_scan(0.2));
    DenoiseOptions options;
    options.method = DenoiseMethod::soft_threshold;
    options.cycle_spins = 2;
    Session session;
    const Result first = denoise(layer, options, session), second = denoise(layer, options, session);
    EXPECT_FALSE(value<bool>(first.report, "pyramid_reused"));
    EXPECT_TRUE(value<bool>(second.report, "pyramid_reused"));
    EXPECT_EQ(*first.positions, *second.positions);
}

// F1: the world's z was the normal of all rows of details that are stored in its axes.
TEST(DenoiseThreshold, AnOpenScanTurnsWithItsResult) {
    Mesh mesh = noisy_scan(0.2);  // its upper half
    Faces faces;
    for (const Face& f : mesh.faces)
        if (std::all_of(f.begin(), f.end(), [&](Index v) { return mesh.positions[v].z() > 0.1; })) faces.push_back(f);
    mesh.faces = faces;
    const double diagonal = box_diagonal(layer_of(mesh));
    int way = 0;  // each takes two of the four combinations, for time
    for (DenoiseOptions options : every_way()) {
        const bool turn = way++ % 3 == 0;
        for (const bool keep_volume : {false, true}) {
            options.normal_only = keep_volume == turn;
            options.per_level = turn;
            options.keep_volume = keep_volume;
            Motion motion;
            const Vec3 axis = keep_volume ? Vec3(1, 0, 0) : Vec3(0.3, -0.8, 0.5);
            motion.rotation = Eigen::AngleAxisd(1.57, axis.normalized()).toRotationMatrix();
            Positions expected = denoised(mesh, options);
            for (Vec3& p : expected) p = motion(p);
            EXPECT_LE(largest_distance(denoised(motion(mesh), options), expected), 1e-9 * diagonal)
                << "scheme " << options.pyramid.scheme.row << ", method " << static_cast<int>(options.method)
                << ", presmooth " << options.pyramid.scheme.presmooth << ", normal only " << options.normal_only
                << ", volume " << keep_volume;
        }
    }
}

}  // namespace multires
