#include "denoise/edge_fit.h"
#include "denoise/noise.h"
#include "denoise/within_surface.h"

#include "denoise_fixtures.h"

namespace multires {

using namespace fixtures;

namespace {

/// A grid of n by n squares of side 1 with random heights, and the diagonals as they come.
struct Crumpled {
    Mesh mesh;
    Index n;

    Crumpled(Index squares, double height) : n(squares) {
        shapes::Random random(3);
        for (Index y = 0; y <= n; ++y)
            for (Index x = 0; x <= n; ++x) mesh.positions.emplace_back(x, y, height * gaussian(random));
        mesh.faces.resize(2 * n * n);
        for (Index cell = 0; cell < n * n; ++cell) set(cell, random.chance(0.5));
    }

    void set(Index cell, bool rising) {
        const Index a = cell / n * (n + 1) + cell % n, b = a + 1, c = a + n + 1, d = c + 1;
        mesh.faces[2 * cell] = rising ? Face{a, b, d} : Face{a, b, c};
        mesh.faces[2 * cell + 1] = rising ? Face{a, d, c} : Face{b, d, c};
    }

    /// Lengths by angles of the edges of a cell and of those around it.
    double bend_around(Index cell) const {
        std::vector<Face> around;
        for (Index other = 0; other < n * n; ++other)
            if (std::abs(other / n - cell / n) <= 1 && std::abs(other % n - cell % n) <= 1)
                around.insert(around.end(), {mesh.faces[2 * other], mesh.faces[2 * other + 1]});
        double sum = 0;
        for (std::size_t i = 0; i < around.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                std::vector<Vec3> common;
                for (const Index v : around[i])
                    if (std::find(around[j].begin(), around[j].end(), v) != around[j].end())
                        common.push_back(mesh.positions[v]);
                if (common.size() != 2) continue;
                const Vec3 u = normal_of(around[i]), v = normal_of(around[j]);
                sum += (common[0] - common[1]).norm() * std::atan2(u.cross(v).norm(), u.dot(v));
            }
        return sum;
    }

    Vec3 normal_of(const Face& f) const {
        const Vec3& a = mesh.positions[f[0]];
        return (mesh.positions[f[1]] - a).cross(mesh.positions[f[2]] - a).normalized();
    }

    /// Lays the diagonals as they bend the surface least: a coarse mesh of a shape.
    void fit_edges() {
        for (int round = 0; round < 3; ++round)
            for (Index cell = 0; cell < n * n; ++cell) {
                std::array<double, 2> bend{};
                for (const bool rising : {false, true}) {
                    set(cell, rising);
                    bend[rising] = bend_around(cell);
                }
                set(cell, bend[1] < bend[0]);
            }
    }
};

SurfaceNoise noise_of(const Mesh& mesh) {
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()));
    return surface_noise(mesh.faces, mesh.positions, at, neighbours(mesh.faces, at),
                         mean_edge_length(mesh.faces, mesh.positions));
}

}  // namespace

TEST(EdgeFit, IsTheCurvatureThatTurnedEdgesAdd) {
    // Two squares that meet in a crease of 90 degrees along x = 0, with diagonals: those can be turned for nothing, the
    // crease cannot be turned without a bend across it.
    const Positions roof = {{-1, 0, -1}, {-1, 1, -1}, {0, 0, 0}, {0, 1, 0}, {1, 0, -1}, {1, 1, -1}};
    const Faces faces = {{0, 2, 1}, {2, 3, 1}, {2, 4, 3}, {4, 5, 3}};
    Positions shallow = roof;
    for (Vec3& p : shallow) p.z() *= 0.1;
    const double fit = EdgeFit(faces).of(shallow);
    EXPECT_GT(fit, 0.2);
    // The same whichever way the faces are turned, and no matter which of them come first.
    Faces turned = faces;
    for (Face& f : turned) std::swap(f[1], f[2]);
    EXPECT_NEAR(EdgeFit(turned).of(shallow), fit, 1e-12);
    EXPECT_NEAR(EdgeFit({faces[3], faces[1], faces[0], faces[2]}).of(shallow), fit, 1e-12);
    Positions flat = roof;
    for (Vec3& p : flat) p.z() = 0;
    EXPECT_EQ(EdgeFit(faces).of(flat), 0);
    EXPECT_EQ(EdgeFit({}).of({}), 0);
    // Of four corners that go up and down in turn both diagonals bend alike.
    EXPECT_NEAR(EdgeFit({{0, 1, 2}, {0, 2, 3}}).of({{0, 0, 0}, {1, 0, 0.3}, {1, 1, 0}, {0, 1, 0.3}}), 0, 1e-12);
}

TEST(EdgeFit, TellsACoarseShapeFromNoise) {
    Crumpled crumpled(16, 0.3);
    EXPECT_GT(noise_of(crumpled.mesh).by_edges, 0.9);
    const double as_noise = displacement(crumpled.mesh.positions, denoised(crumpled.mesh)).rms;
    EXPECT_GT(as_noise, 0.2);
    crumpled.fit_edges();
    EXPECT_LT(noise_of(crumpled.mesh).by_edges, 0.6);
    EXPECT_LT(displacement(crumpled.mesh.positions, denoised(crumpled.mesh)).rms, 0.2 * as_noise);
    Session session;
    const Result result = denoise(layer_of(crumpled.mesh), {}, session);
    std::string log;
    for (const std::string& line : result.report.lines()) log += line;
    EXPECT_NE(log.find("is taken for shape"), std::string::npos) << log;
}

TEST(EdgeFit, KnowsNoiseOnFineMeshes) {
    for (const Mesh& truth : {shapes::irregular_sphere(2000), shapes::block(10), shapes::scan(3000)}) {
        Mesh noisy = truth;
        noisy.positions = with_noise(truth, 0.1);
        EXPECT_GT(noise_of(noisy).by_edges, 0.9);
    }
}

TEST(SurfaceNoise, WeakNoiseIsFoundByFifthDifferences) {
    const Mesh truth = shapes::irregular_sphere(700);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Mesh noisy = truth;
        noisy.positions = with_noise(truth, 0.02, NoiseKind::along_normals, seed);
        const double edge = mean_edge_length(truth.faces, truth.positions);
        EXPECT_GT(noise_of(noisy).along_normals, 0.0075 * edge);  // by third differences alone 0.003 to 0.007
    }
}

TEST(WithinSurface, FoldsAtBendsOfCoarseShapesAreNoSignOfNoise) {
    std::array<int, 2> found{};
    for (std::uint64_t seed = 1; seed <= 8; ++seed)
        for (const NoiseKind kind : {NoiseKind::along_normals, NoiseKind::all_directions}) {
            shapes::Irregular irregular;
            irregular.seed = seed;
            Mesh block = shapes::block(5, irregular);
            block.positions = with_noise(block, 0.1, kind, seed);
            const Incidence at = vertex_faces(block.faces, static_cast<Index>(block.positions.size()));
            const WithinSurface within =
                relax_within_surface(block.faces, block.positions, neighbours(block.faces, at), noise_of(block),
                                     mean_edge_length(block.faces, block.positions));
            found[kind == NoiseKind::all_directions] += within.noisy;
        }
    EXPECT_LE(found[0], 1);
    EXPECT_GE(found[1], 5);
}

// A sampling may be as irregular as noise of some strength makes it, but hardly folds. Of noise 19 of 24 were found.
TEST(WithinSurface, PlacesAsIrregularAsNoiseMakesThemAreNoiseIfSomeFacesAreFolded) {
    const Mesh truth = shapes::torus(80, 36);
    const Incidence at = vertex_faces(truth.faces, static_cast<Index>(truth.positions.size()));
    const double edge = mean_edge_length(truth.faces, truth.positions);
    for (const double deviation : {0.15, 0.18, 0.2})
        for (std::uint64_t seed = 1; seed <= 8; ++seed)
            for (const NoiseKind kind : {NoiseKind::along_normals, NoiseKind::all_directions}) {
                SurfaceNoise noise;
                noise.along_normals = noise.at_least = noise.within_surface = deviation * edge;
                noise.maybe_all = noise.likely_all = noise.surely_all = true;
                const WithinSurface within = relax_within_surface(truth.faces, with_noise(truth, deviation, kind, seed),
                                                                  neighbours(truth.faces, at), noise, edge);
                EXPECT_EQ(within.noisy, kind == NoiseKind::all_directions) << deviation << ", " << seed;
            }
}

}  // namespace multires
