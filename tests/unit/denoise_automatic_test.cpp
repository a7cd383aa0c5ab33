#include "filters/shape/denoise.h"

#include "denoise/automatic.h"
#include "denoise/lattice.h"
#include "denoise/left_error.h"
#include "denoise_fixtures.h"
#include "normals/spikes.h"

#include <set>
#include <tuple>

namespace multires {

using namespace fixtures;

namespace {

/// Noise beside that of NoiseKind.
enum class Model { along_normals, all_directions, impulsive, along_axis, quantised };

constexpr Model models[] = {Model::along_normals, Model::all_directions, Model::impulsive, Model::along_axis,
                            Model::quantised};

/// @param deviation  mean edge lengths; quantised: of the coordinates' rounding errors
Mesh noisy(const Mesh& truth, Model model, double deviation, std::uint64_t seed = 1) {
    Mesh mesh = truth;
    if (model == Model::along_normals) mesh.positions = with_noise(truth, deviation, NoiseKind::along_normals, seed);
    if (model == Model::all_directions) mesh.positions = with_noise(truth, deviation, NoiseKind::all_directions, seed);
    if (model == Model::impulsive) mesh.positions = with_noise(truth, deviation, NoiseKind::impulsive, seed);
    const double size = deviation * mean_edge_length(truth.faces, truth.positions);
    shapes::Random random(seed);
    const Vec3 axis = Vec3(0.36, 0.48, 0.8);
    const double step = size * std::sqrt(12.0), offset = 0.37;
    for (Vec3& p : mesh.positions) {
        if (model == Model::along_axis) p += size * gaussian(random) * axis;
        if (model == Model::quantised)
            for (int k = 0; k < 3; ++k) p[k] = (std::round(p[k] / step + offset) - offset) * step;
    }
    return mesh;
}

struct Shape {
    const char* name;
    Mesh mesh;
};

std::vector<Shape> clean_shapes() {
    shapes::BandedSphereOptions waves;
    waves.vertices = 3000;
    waves.low_amplitude = 0.06;
    waves.high_degree = 12;
    waves.high_amplitude = 0.015;
    return {{"sphere", shapes::irregular_sphere(3000)},
            {"block", shapes::block(11)},
            {"waves", shapes::banded_sphere(waves).mesh},
            {"scan", shapes::scan(3000)},
            {"torus", shapes::torus(80, 36)},
            {"cylinder", shapes::open_cylinder(80, 30)},
            {"terrain", shapes::terrain(54).mesh}};
}

/// A grid of cliffs that go across it: their jags stand out as impulses do.
Mesh cliffs(Index side) {
    Mesh mesh = shapes::plane(side, {0, 0, 1});
    for (Vec3& p : mesh.positions) p.z() = 0.08 * std::floor(3.3 * p.x() + 1.05 * p.y());
    return mesh;
}

Result run(const Layer& layer, const DenoiseOptions& options = {}) {
    Session session;
    return denoise(layer, options, session);
}

double edge_of(const Mesh& mesh) { return mean_edge_length(mesh.faces, mesh.positions); }

double rms_distance(const Positions& a, const Positions& b) { return displacement(a, b).rms; }

}  // namespace

TEST(AutomaticDenoise, IsNeverWorseThanDoingNothing) {
    for (const Shape& shape : clean_shapes())
        for (const Model model : models)
            for (const double deviation : {0.02, 0.05, 0.2, 0.5}) {
                SCOPED_TRACE(std::string(shape.name) + ", noise model " + std::to_string(static_cast<int>(model)) +
                             ", " + std::to_string(deviation));
                const Mesh mesh = noisy(shape.mesh, model, deviation);
                const Positions after = denoised(mesh);
                const auto angle = [&](const Positions& p) {
                    return mean_normal_angle(mesh.faces, p, shape.mesh.positions);
                };
                EXPECT_LE(angle(after), angle(mesh.positions));
                EXPECT_LE(rms_distance(after, shape.mesh.positions),
                          rms_distance(mesh.positions, shape.mesh.positions));
            }
}

TEST(AutomaticDenoise, LeavesMostNoiseOfSmoothShapesBehind) {
    // Share of the angle and of the distance that may remain: 1.3 times what was measured.
    struct Limit {
        const char* name;
        Mesh mesh;
        double angle, rms;
    };
    const Limit limits[] = {{"sphere", shapes::irregular_sphere(4000), 0.16, 0.42},
                            {"block", shapes::block(13), 0.25, 0.6},
                            {"scan", shapes::scan(4000), 0.35, 0.6}};
    for (const Limit& limit : limits)
        for (const double deviation : {0.1, 0.2, 0.3}) {
            SCOPED_TRACE(limit.name + std::string(", ") + std::to_string(deviation));
            const Mesh mesh = noisy(limit.mesh, Model::along_normals, deviation);
            const Error before = error_of(limit.mesh, mesh.positions), after = error_of(limit.mesh, denoised(mesh));
            EXPECT_LE(after.angle, limit.angle * before.angle);
            EXPECT_LE(after.rms, limit.rms * before.rms);
        }
}

TEST(AutomaticDenoise, RemovesWeakNoiseWithinTheSurfaceToo) {
    const Mesh truth = shapes::torus(80, 36);
    const Mesh mesh = noisy(truth, Model::all_directions, 0.05);
    const double before = rms_distance(mesh.positions, truth.positions);
    // Along the normals alone 0.82 of the distance would be left, and 0.59 if it was not sure.
    EXPECT_LT(rms_distance(denoised(mesh), truth.positions), 0.5 * before);
}

TEST(AutomaticDenoise, BelievesNoiseBetweenManyCreases) {
    const Mesh truth = shapes::block(7);
    const Mesh mesh = noisy(truth, Model::along_normals, 0.07);
    const Error before = error_of(truth, mesh.positions), after = error_of(truth, denoised(mesh));
    EXPECT_LT(after.angle, 0.5 * before.angle);
    EXPECT_LT(after.rms, 0.8 * before.rms);
}

// The jags stand out of what is around them as noise does not; what is flat tells.
TEST(AutomaticDenoise, BelievesNoiseBetweenCliffs) {
    const Mesh truth = cliffs(60);
    const Mesh mesh = noisy(truth, Model::along_normals, 0.1);
    const Error before = error_of(truth, mesh.positions), after = error_of(truth, denoised(mesh));
    EXPECT_LT(after.angle, 0.3 * before.angle);
    EXPECT_LT(after.rms, 0.6 * before.rms);
}

TEST(AutomaticDenoise, KnowsTheNoise) {
    for (const Shape& shape : clean_shapes())
        for (const double deviation : {0.03, 0.1, 0.3, 0.5}) {
            SCOPED_TRACE(std::string(shape.name) + ", " + std::to_string(deviation));
            const Mesh mesh = noisy(shape.mesh, Model::along_normals, deviation);
            const double found = number(run(layer_of(mesh)).report, "noise") / edge_of(shape.mesh);
            EXPECT_NEAR(found / deviation, 1, deviation < 0.05 ? 0.25 : 0.15);
        }
}

TEST(AutomaticDenoise, ForeseesTheDistanceFromTheTruth) {
    for (const Shape& shape : clean_shapes())
        for (const double deviation : {0.1, 0.3}) {
            SCOPED_TRACE(std::string(shape.name) + ", " + std::to_string(deviation));
            const Mesh mesh = noisy(shape.mesh, Model::along_normals, deviation);
            const Result result = run(layer_of(mesh));
            // The estimate is a difference of squares: its error goes with the noise that was there. Errors across
            // creases, where the normal field moves vertices sideways, it does not see.
            const auto squared = [&](const char* key) { return std::pow(number(result.report, key), 2); };
            const double noise = std::pow(deviation * edge_of(shape.mesh), 2);
            EXPECT_NEAR(squared("estimated_rms_before") / noise, 1, 0.3);
            EXPECT_NEAR(squared("estimated_rms_after") / noise,
                        std::pow(rms_distance(*result.positions, shape.mesh.positions), 2) / noise, 0.2);
        }
}

TEST(AutomaticDenoise, KeepsTheDetailOfMeshesWithoutNoise) {
    for (const Shape& shape : clean_shapes())
        EXPECT_LE(rms_distance(denoised(shape.mesh), shape.mesh.positions), 0.02 * edge_of(shape.mesh)) << shape.name;
}

TEST(AutomaticDenoise, LeavesARoughSurfaceAsItIs) {
    const Mesh rough = rough_terrain(54);
    EXPECT_LE(rms_distance(denoised(rough), rough.positions), 0.005 * edge_of(rough));
    const Mesh mesh = noisy(rough, Model::along_normals, 0.05);
    EXPECT_LE(rms_distance(denoised(mesh), rough.positions), 0.051 * edge_of(rough));
}

// Terrain hides that the noise is white, but does not hide that faces are folded.
TEST(AutomaticDenoise, NoiseThatFoldsFacesNeedBeLessWhite) {
    const Mesh rough = rough_terrain(54);
    const Mesh mesh = noisy(rough, Model::all_directions, 0.2);
    const Error before = error_of(rough, mesh.positions), after = error_of(rough, denoised(mesh));
    EXPECT_LT(after.angle, 0.7 * before.angle);
    EXPECT_LT(after.rms, 0.73 * before.rms);
}

TEST(AutomaticDenoise, TellsCreasesFromOrganicShapes) {
    const Report part = run(layer_of(noisy(shapes::block(13), Model::along_normals, 0.1))).report;
    EXPECT_GT(number(part, "share_normal_field") + number(part, "share_guided_normals"), 0.99);
    const Report scan = run(layer_of(noisy(shapes::scan(4000), Model::along_normals, 0.1))).report;
    EXPECT_LT(number(scan, "share_normal_field") + number(scan, "share_guided_normals"), 0.5);
}

TEST(AutomaticDenoise, FindsNoiseWithinTheSurface) {
    for (const Shape& shape : clean_shapes()) {
        const auto within = [&](Model model) {
            const Mesh mesh = noisy(shape.mesh, model, 0.3);
            return value<bool>(run(layer_of(mesh)).report, "noise_in_all_directions");
        };
        EXPECT_TRUE(within(Model::all_directions)) << shape.name;
        EXPECT_FALSE(within(Model::along_normals)) << shape.name;
    }
}

TEST(AutomaticDenoise, FindsNoiseAlongAnAxis) {
    for (const Shape& shape : clean_shapes())
        for (const Model model : {Model::along_axis, Model::along_normals, Model::all_directions, Model::impulsive})
            for (const double deviation : {0.05, 0.2}) {
                SCOPED_TRACE(std::string(shape.name) + ", noise model " + std::to_string(static_cast<int>(model)) +
                             ", " + std::to_string(deviation));
                const Mesh mesh = noisy(shape.mesh, model, deviation);
                const Result result = run(layer_of(mesh));
                // A terrain faces one way: there it makes no difference.
                const bool axis = model == Model::along_axis;
                if (!axis || shape.name != std::string("terrain")) {
                    EXPECT_EQ(value<bool>(result.report, "noise_along_axis"), axis);
                }
                if (!axis || deviation < 0.1) continue;
                const Positions after = result.positions.value_or(mesh.positions);
                EXPECT_LE(error_of(shape.mesh, after).angle, 0.5 * error_of(shape.mesh, mesh.positions).angle);
                // What crosses the surface is seen along the normals, and goes with it.
                const double left = rms_distance(shape.mesh.positions, after);
                EXPECT_LE(left, 0.8 * rms_distance(shape.mesh.positions, mesh.positions));
                if (shape.name == std::string("sphere") || shape.name == std::string("scan")) {
                    EXPECT_NEAR(number(result.report, "estimated_rms_after"), left, 0.15 * left);
                }
            }
}

TEST(AutomaticDenoise, RemovesWeakNoiseAlongAnAxisFromMachinedParts) {
    const Mesh truth = shapes::block(18);
    for (const std::uint64_t seed : {1, 2}) {
        const Mesh mesh = noisy(truth, Model::along_axis, 0.05, seed);
        const Result result = run(layer_of(mesh));
        EXPECT_TRUE(value<bool>(result.report, "noise_along_axis"));
        const Error before = error_of(truth, mesh.positions), after = error_of(truth, *result.positions);
        EXPECT_LE(after.angle, 0.4 * before.angle);
        EXPECT_LE(after.rms, 0.8 * before.rms);
    }
}

TEST(AutomaticDenoise, TellsAnAxisFromChanceOnSmallMeshes) {
    const auto found = [](const Mesh& truth, Model model) {
        int times = 0;
        for (std::uint64_t seed = 1; seed <= 15; ++seed)
            times += value<bool>(run(layer_of(noisy(truth, model, 0.2, seed))).report, "noise_along_axis");
        return times;
    };
    int by_chance = 0;
    for (const Mesh& truth : {shapes::scan(200), shapes::irregular_sphere(200), shapes::irregular_sphere(350)})
        for (const Model model : {Model::along_normals, Model::all_directions, Model::impulsive})
            by_chance += found(truth, model);
    EXPECT_LE(by_chance, 1);  // of 135
    EXPECT_GE(found(shapes::irregular_sphere(350), Model::along_axis), 10);
}

TEST(AutomaticDenoise, LeavesTheJagsOfCliffsAlone) {
    const Mesh truth = cliffs(60);
    for (const double deviation : {0.05, 0.1, 0.2}) {
        SCOPED_TRACE(deviation);
        const Mesh mesh = noisy(truth, Model::impulsive, deviation);
        const Positions after = run(layer_of(mesh)).positions.value_or(mesh.positions);
        EXPECT_LE(rms_distance(truth.positions, after), rms_distance(truth.positions, mesh.positions));
    }
}

// Scanners' impulses are of all sizes: those far larger than most are not taken for shape.
TEST(AutomaticDenoise, TakesGiantImpulsesBackAmongSmallOnes) {
    const Mesh truth = shapes::irregular_sphere(4000);
    Mesh mesh = noisy(truth, Model::impulsive, 0.3);
    const Positions normal = fixtures::vertex_normals(truth);
    for (std::size_t v = 50; v < mesh.positions.size(); v += 200)
        mesh.positions[v] = truth.positions[v] + (v % 400 == 50 ? 5 : -5) * edge_of(truth) * normal[v];
    const Positions after = *run(layer_of(mesh)).positions;
    EXPECT_LT(rms_distance(truth.positions, after), 0.3 * rms_distance(truth.positions, mesh.positions));
}

TEST(AutomaticDenoise, PutsSingleOutliersBackAndMovesNothingElse) {
    for (const Mesh& clean : {shapes::irregular_sphere(4000), shapes::scan(4000), shapes::block(10)})
        for (const bool along_normals : {true, false}) {
            Mesh mesh = clean;
            const Positions normal = fixtures::vertex_normals(mesh);
            const double edge = edge_of(mesh);
            shapes::Random random(3);
            std::set<std::size_t> moved;
            while (moved.size() < 16)
                moved.insert(static_cast<std::size_t>(random.uniform() * static_cast<double>(normal.size())));
            for (const std::size_t v : moved) {
                const Vec3 any(gaussian(random), gaussian(random), gaussian(random));
                mesh.positions[v] +=
                    (4 + 20 * random.uniform()) * edge * (along_normals ? normal[v] : any.normalized());
            }
            const Result result = run(layer_of(mesh));
            const Positions& after = *result.positions;
            for (std::size_t v = 0; v < normal.size(); ++v)
                EXPECT_TRUE(moved.count(v) > 0 || after[v] == mesh.positions[v]);
            EXPECT_GE(count(result.report, "spikes_removed"), 13) << along_normals;
            EXPECT_LT(rms_distance(clean.positions, after), 0.5 * rms_distance(clean.positions, mesh.positions));
        }
}

TEST(AutomaticDenoise, KeepsTipsThatTheShapeHas) {
    Mesh cone = shapes::plane(40, {0.2, 0, 1});  // grown from the plate in rings
    for (Vec3& p : cone.positions) p.z() = std::max(0.0, 1 - 8 * (p - Vec3(0.5, 0.5, 0)).norm());
    Mesh studs = shapes::plane(40, {0, 0, 1});  // of one vertex to five
    for (Index i = 0; i < 60; ++i) {
        const Index row = i / 10;
        const Vec3 middle(0.1 + 0.08 * (i % 10), 0.1 + 0.14 * row, 0);
        for (Vec3& p : studs.positions)
            p.z() =
                std::max(p.z(), 4 * (0.02 + 0.0004 * i) - 4 * Vec3(p.x() - middle.x(), p.y() - middle.y(), 0).norm());
    }
    for (const Mesh& mesh : {cone, studs})
        EXPECT_EQ(run(layer_of(mesh)).positions.value_or(mesh.positions), mesh.positions);
}

TEST(AutomaticDenoise, TakesRoundedCoordinatesBackWithinTheirCells) {
    for (const Mesh& truth : {shapes::irregular_sphere(3000), shapes::scan(3000)})
        for (const double deviation : {0.05, 0.2, 0.4}) {
            SCOPED_TRACE(deviation);
            const Mesh mesh = noisy(truth, Model::quantised, deviation);
            const Result result = run(layer_of(mesh));
            const double step = deviation * edge_of(truth) * std::sqrt(12.0);
            EXPECT_NEAR(number(result.report, "rounding_step"), step, 1e-9 * step);
            const Error before = error_of(truth, mesh.positions), after = error_of(truth, *result.positions);
            EXPECT_LE(after.angle, 0.4 * before.angle);
            EXPECT_LE(after.rms, 0.75 * before.rms);
            for (std::size_t i = 0; i < mesh.positions.size(); ++i)
                ASSERT_LE(((*result.positions)[i] - mesh.positions[i]).cwiseAbs().maxCoeff(), (0.5 + 1e-9) * step);
        }
}

namespace {

Positions denoised(const Mesh& mesh, AutomaticStats& stats) {
    return denoise_automatically(mesh.faces, mesh.positions, {}, stats, [](double, const char*) {});
}

Mesh turned_block() {
    Mesh mesh = shapes::block(24);
    const Eigen::AngleAxisd turn(0.7, Vec3(0.36, 0.48, 0.8));
    for (Vec3& p : mesh.positions) p = turn * p;
    return mesh;
}

void expect_no_patches(const Mesh& truth, Model model, double deviation) {
    AutomaticStats stats;
    denoised(noisy(truth, model, deviation), stats);
    EXPECT_EQ(stats.patches, 0);
}

}  // namespace

// Terraces are as flat as the faces they are on; only that these are planes tells the truth.
TEST(AutomaticDenoise, FindsPlanesThatWereRounded) {
    const Mesh truth = turned_block();
    for (const double deviation : {0.05, 0.2}) {
        SCOPED_TRACE(deviation);
        const Mesh mesh = noisy(truth, Model::quantised, deviation);
        AutomaticStats stats;
        const Positions after = denoised(mesh, stats);
        EXPECT_GE(stats.patches, 5);
        const Error before = error_of(truth, mesh.positions), left = error_of(truth, after);
        EXPECT_LT(left.angle, 0.1 * before.angle);
        EXPECT_LT(left.rms, 0.3 * before.rms);
        for (std::size_t i = 0; i < after.size(); ++i)
            ASSERT_LE((after[i] - mesh.positions[i]).cwiseAbs().maxCoeff(), (0.5 + 1e-9) * stats.step);
    }
    for (const Mesh& shape : {shapes::scan(3000), shapes::irregular_sphere(3000)})
        expect_no_patches(shape, Model::quantised, 0.1);
}

// What follows the normals of terraces keeps them, where there is no patch, too.
TEST(AutomaticDenoise, SmoothsWithinTheCells) {
    const Mesh truth = shapes::torus(80, 36), mesh = noisy(truth, Model::quantised, 0.05);
    const Result result = run(layer_of(mesh));
    const Error before = error_of(truth, mesh.positions), after = error_of(truth, *result.positions);
    EXPECT_LT(after.angle, 0.1 * before.angle);
    EXPECT_LT(after.rms, 0.45 * before.rms);
}

// A plane through hundreds of noisy vertices is far better known than the normals of their faces.
TEST(AutomaticDenoise, FindsPlanesUnderGaussianNoise) {
    const Mesh truth = turned_block();
    for (const Model model : {Model::along_normals, Model::all_directions})
        for (const double deviation : {0.1, 0.2}) {
            SCOPED_TRACE(deviation);
            const Mesh mesh = noisy(truth, model, deviation);
            AutomaticStats stats;
            const Positions after = denoised(mesh, stats);
            EXPECT_GE(stats.patches, 5);
            const Error before = error_of(truth, mesh.positions), left = error_of(truth, after);
            EXPECT_LT(left.angle, 0.06 * before.angle);
            EXPECT_LT(left.rms, 0.3 * before.rms);
        }
    for (const Mesh& shape : {shapes::scan(3000), shapes::irregular_sphere(3000)})
        for (const double deviation : {0.1, 0.3}) expect_no_patches(shape, Model::along_normals, deviation);
}

// Patches leave less than what is measured before them, what keeps creases moves vertices within the surface, and
// planes along the axes were rounded by as much as cannot be seen.
TEST(AutomaticDenoise, ForeseesWhatIsLeftOfMachinedParts) {
    for (const auto& [truth, model, deviation] : {std::tuple(turned_block(), Model::along_normals, 0.1),
                                                  {shapes::block(16), Model::along_normals, 0.1},
                                                  {shapes::block(16), Model::quantised, 0.2}}) {
        SCOPED_TRACE(std::to_string(truth.positions.size()) + " vertices, " + std::to_string(deviation));
        AutomaticStats stats;
        const Positions after = denoised(noisy(truth, model, deviation), stats);
        EXPECT_NEAR(stats.rms_after / rms_distance(after, truth.positions), 1, 0.1);
    }
}

TEST(AutomaticDenoise, TakesTheStairsOfVoxelsForNoise) {
    const Mesh truth = shapes::irregular_sphere(6000);
    const double edge = edge_of(truth), voxel = 1.2 * edge;
    Mesh mesh = truth;
    for (Vec3& p : mesh.positions) {  // to the nearest middle of an edge of the grid of voxels
        Vec3 best = Vec3::Constant(1e9);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 middle;
            for (int c = 0; c < 3; ++c)
                middle[c] = voxel * (c == axis ? std::floor(p[c] / voxel) + 0.5 : std::round(p[c] / voxel));
            if ((middle - p).norm() < (best - p).norm()) best = middle;
        }
        p = best;
    }
    const std::optional<double> step = lattice_step(mesh.positions, 0.03 * edge);
    ASSERT_TRUE(step);
    EXPECT_NEAR(*step, voxel / 2, 1e-9);
    EXPECT_TRUE(between_voxels(mesh.positions, *step));
    EXPECT_FALSE(between_voxels(noisy(truth, Model::quantised, 0.2).positions, 0.2 * std::sqrt(12.0) * edge));
    const Result result = run(layer_of(mesh));
    EXPECT_EQ(number(result.report, "share_normal_field") + number(result.report, "share_guided_normals"), 0);
    const Error before = error_of(truth, mesh.positions), after = error_of(truth, *result.positions);
    EXPECT_LT(after.angle, 0.3 * before.angle);
    EXPECT_LT(after.rms, 0.4 * before.rms);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        ASSERT_LE(((*result.positions)[i] - mesh.positions[i]).cwiseAbs().maxCoeff(), (1 + 1e-9) * *step);
}

TEST(AutomaticDenoise, BelievesRoundingBesidePlanesAlongTheAxes) {
    const Mesh truth = shapes::block(24);
    for (const double deviation : {0.05, 0.1}) {
        SCOPED_TRACE(deviation);
        const Mesh mesh = noisy(truth, Model::quantised, deviation);
        const Result result = run(layer_of(mesh));
        EXPECT_GT(number(result.report, "rounding_step"), 0);
        const Error before = error_of(truth, mesh.positions), after = error_of(truth, *result.positions);
        EXPECT_LT(after.angle, 0.6 * before.angle);
        EXPECT_LT(after.rms, before.rms);
        for (std::size_t v = 0; v < truth.positions.size(); ++v) {
            if (truth.positions[v].y() == 0) {
                ASSERT_EQ((*result.positions)[v].y(), mesh.positions[v].y());
            }
        }
    }
}

TEST(AutomaticDenoise, MovesNoVertexFartherThanNoise) {
    Mesh truth = shapes::block(13);  // flattened to a sheet
    for (Vec3& p : truth.positions) p.z() *= 0.02;
    for (const Mesh& shape : {truth, shapes::scan(2000)}) {
        const Mesh mesh = noisy(shape, Model::along_normals, 0.05);
        const Result result = run(layer_of(mesh));
        const double noise = number(result.report, "noise");
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            ASSERT_LE(((*result.positions)[i] - mesh.positions[i]).norm(), 5.5 * noise);
    }
}

TEST(AutomaticDenoise, BringsCreasesBackThatImpulsesMet) {
    const Mesh truth = shapes::block(15), mesh = noisy(truth, Model::impulsive, 0.3);
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()));
    Index spikes = 0;
    const Positions set_back = without_spikes(mesh.faces, mesh.positions, at, spikes);
    EXPECT_LE(error_of(truth, denoised(mesh)).angle, 0.8 * error_of(truth, set_back).angle);
}

TEST(AutomaticDenoise, ChangesNoBitAtStrengthZero) {
    const Mesh mesh = noisy(shapes::irregular_sphere(1000), Model::along_normals, 0.2);
    DenoiseOptions options;
    options.strength = 0;
    EXPECT_EQ(denoised(mesh, options), mesh.positions);
}

TEST(AutomaticDenoise, GivesTheSameBitsOnPatchesOfALargeMesh) {
    const Mesh truth = shapes::irregular_sphere(26000), mesh = noisy(truth, Model::all_directions, 0.2);
    std::array<double, 2> angle{};
    for (const bool fast : {false, true}) {
        DenoiseOptions options;
        options.fast = fast;
        Positions first;
        for (const int threads : {1, 3}) {
            const Threads scope(threads);
            const Positions p = denoised(mesh, options);
            if (threads == 1)
                first = p;
            else
                EXPECT_EQ(p, first);
        }
        angle[fast] = mean_normal_angle(truth.faces, truth.positions, first);
    }
    EXPECT_LT(angle[1], 1.2 * angle[0]);
    EXPECT_NE(angle[1], angle[0]);
}

TEST(AutomaticDenoise, FastIsTheSameOnSmallMeshes) {
    const Mesh mesh = noisy(shapes::torus(40, 18), Model::along_normals, 0.2);
    DenoiseOptions options;
    options.fast = true;
    EXPECT_EQ(denoised(mesh, options), denoised(mesh));
}

TEST(AutomaticDenoise, StopsWhenTold) {
    const Layer layer = layer_of(noisy(shapes::irregular_sphere(1000), Model::along_normals, 0.2));
    int calls = 0;
    Session counting;
    counting.progress = Progress([&](int, const char*) { return ++calls > 0; });
    denoise(layer, {}, counting);
    ASSERT_GT(calls, 20);
    for (const int last : {1, calls / 3, calls - 1}) {
        Session session;
        int made = 0;
        session.progress = Progress([&](int, const char*) { return ++made < last; });
        EXPECT_THROW(denoise(layer, {}, session), Cancelled);
        EXPECT_EQ(made, last);
    }
}

TEST(LeftError, IsWithoutWhatVerticesMovedIntoPatches) {
    const Mesh flat = shapes::plane(20, {0, 0, 1});
    const double count = static_cast<double>(flat.positions.size());
    Positions bumpy = flat.positions;
    for (std::size_t v = 0; v < bumpy.size(); ++v) bumpy[v] += Vec3(0.03, 0, v % 2 == 0 ? 0.01 : -0.01);
    EXPECT_NEAR(moved_within(flat.faces, bumpy, flat.positions), 9e-4, 1e-12);
    SmoothRegions regions{std::vector<Index>(flat.faces.size(), -1), {}};
    EXPECT_EQ(error_after_patches(3e-4, 1e-2, flat.faces, regions, bumpy, flat.positions), 3e-4);
    std::fill(regions.of_face.begin(), regions.of_face.end(), 0);
    regions.patch.push_back({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)});
    EXPECT_NEAR(error_after_patches(3e-4, 1e-2, flat.faces, regions, bumpy, flat.positions), 2e-4 + 3e-2 / count,
                1e-12);
    regions.patch[0].bend = {1, 0, 0};
    EXPECT_NEAR(error_after_patches(5e-5, 1e-2, flat.faces, regions, bumpy, flat.positions), 6e-2 / count, 1e-12);
}

TEST(Risk, OfALinearFilterIsItsMeanSquareError) {
    // The candidate takes away the part g of every height: its error is (1 - g) noise - g shape.
    const Mesh mesh = shapes::plane(60);
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()));
    const Neighbours near = neighbours(mesh.faces, at);
    const std::size_t count = mesh.positions.size();
    const double s = 0.3;
    std::vector<double> deviation(count, s), probe(count);
    std::vector<Response> candidates(2, Response(2 * count));
    double truth = 0;
    const Eigen::Vector2d t(0.2, 0.3);
    for (std::size_t i = 0; i < count; ++i) {
        const double shape = mesh.positions[i].x(), noise = s * gaussian(static_cast<Index>(i), 11);
        probe[i] = s * gaussian(static_cast<Index>(i), 12);
        for (int k = 0; k < 2; ++k) {
            candidates[k][2 * i] = -(k + 1) * 0.5 * (shape + noise);
            candidates[k][2 * i + 1] = -(k + 1) * 0.5 * probe[i];
        }
        const double gain = 1 - 0.5 * t[0] - t[1];
        truth += std::pow(gain * (shape + noise) - shape, 2) / static_cast<double>(count);
    }
    const Risks r = risks(near, candidates, deviation, probe, std::vector<std::uint8_t>(count, 1));
    EXPECT_NEAR(r.heights.at(t), truth, 0.05 * s * s);
    EXPECT_NEAR(r.heights.constant, s * s, 1e-12);
    EXPECT_NEAR(r.edges.constant, 2 * s * s, 1e-12);
}

TEST(Risk, LeastIsOnTheSimplexAndNoVertexOfItIsBetter) {
    Risk risk;
    risk.constant = 1;
    risk.linear = Eigen::Vector3d(-0.9, -0.5, 0.2);
    risk.quadratic = Eigen::Vector3d(1.1, 0.4, 0.3).asDiagonal();
    const Eigen::VectorXd t = least_risk(risk);
    EXPECT_GE(t.minCoeff(), 0);
    EXPECT_LE(t.sum(), 1 + 1e-12);
    // By hand: with t_0 + t_1 = 1 the slopes -0.9 + 1.1 t_0 and -0.5 + 0.4 t_1 are equal.
    EXPECT_NEAR(t[0], 0.8 / 1.5, 1e-6);
    EXPECT_NEAR(t[1], 0.7 / 1.5, 1e-6);
    EXPECT_EQ(t[2], 0);
    // Nothing to gain: the input stays as it is.
    risk.linear = Eigen::Vector3d(0.1, 0.2, 0.3);
    EXPECT_EQ(least_risk(risk).norm(), 0);
}

}  // namespace multires
