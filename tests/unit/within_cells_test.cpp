#include "denoise/within_cells.h"

#include "measure/measure.h"

#include "denoise_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace multires {

using namespace fixtures;

namespace {

Positions rounded(const Mesh& mesh, double step) {
    Positions p = mesh.positions;
    for (Vec3& v : p)
        for (int k = 0; k < 3; ++k) v[k] = (std::round(v[k] / step + 0.37) - 0.37) * step;
    return p;
}

Positions smoothed(const Mesh& mesh, const Positions& start, double step, bool machined) {
    Positions p = start;
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(p.size()));
    smooth_within_cells(mesh.faces, at, face_graph(mesh.faces, at),
                        std::vector<std::uint8_t>(mesh.faces.size(), machined ? 1 : 0), {}, start, step, 1, p);
    return p;
}

}  // namespace

TEST(WithinCells, TerracesAreMadeSmooth) {
    Mesh truth = shapes::block(24);
    const Eigen::AngleAxisd turn(0.1, Vec3(0.36, 0.48, 0.8));
    for (Vec3& p : truth.positions) p = turn * p;
    const double edge = mean_edge_length(truth.faces, truth.positions);
    for (const double deviation : {0.03, 0.05}) {
        const double step = deviation * edge * std::sqrt(12.0);
        const Positions start = rounded(truth, step);
        for (const bool machined : {true, false}) {
            SCOPED_TRACE(deviation);
            const Positions p = smoothed(truth, start, step, machined);
            const Error before = error_of(truth, start), after = error_of(truth, p);
            EXPECT_LT(after.angle, 0.3 * before.angle);
            EXPECT_LT(after.rms, 0.5 * before.rms);
            for (std::size_t v = 0; v < p.size(); ++v)
                ASSERT_LE((p[v] - start[v]).cwiseAbs().maxCoeff(), (0.5 + 1e-9) * step);
        }
    }
}

// More would go than the errors of rounding.
TEST(WithinCells, TextureStays) {
    Mesh mesh = shapes::irregular_sphere(3000);
    mesh.positions = with_noise(mesh, 0.1, NoiseKind::along_normals, 1);
    const double step = 0.1 * mean_edge_length(mesh.faces, mesh.positions) * std::sqrt(12.0) / 2;
    const Positions start = rounded(mesh, step);
    for (const bool machined : {true, false}) EXPECT_EQ(smoothed(mesh, start, step, machined), start);
}

}  // namespace multires
