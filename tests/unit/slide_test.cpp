#include "bands/slide.h"

#include "bands/directions.h"
#include "bands/spline.h"
#include "base/angles.h"
#include "fixtures.h"
#include "measure/vertex_normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace multires {

namespace {

constexpr Index around = 100, across = 40;

/// A torus whose vertices went inwards by a tenth, and along it by up to 0.045.
struct Slid {
    Mesh mesh = shapes::torus(around, across, 1, 0.4);
    Positions feet = shapes::torus(around, across, 1, 0.3).positions, smooth = feet;

    Slid() {
        for (Index i = 0; i < around; ++i)
            for (Index j = 0; j < across; ++j) {
                const double u = 2 * pi * i / around, v = 2 * pi * j / across + 0.15 * std::sin(3 * u);
                const double r = 1 + 0.3 * std::cos(v);
                smooth[i * across + j] = Vec3(r * std::cos(u), r * std::sin(u), 0.3 * std::sin(v));
            }
    }
    Positions back() const {
        Positions moved = smooth;
        slide_back(mesh, stiffness(mesh), smooth, moved);
        return moved;
    }
};

/// Edges whose two faces lean by more than 60 degrees.
int sharp_edges(const Faces& faces, const Positions& p) {
    std::map<std::pair<Index, Index>, Vec3> first;
    int count = 0;
    for (const Face& f : faces)
        for (int k = 0; k < 3; ++k) {
            const Vec3 normal = area_vector(f, p).normalized();
            const auto edge = std::minmax({f[k], f[(k + 1) % 3]});
            const auto [other, fresh] = first.emplace(edge, normal);
            count += !fresh && other->second.dot(normal) < 0.5;
        }
    return count;
}

}  // namespace

TEST(Slide, VerticesComeToLieOnTheNormalsThroughWhereTheyWere) {
    const Slid slid;
    const Positions moved = slid.back();
    double before = 0, after = 0;
    for (std::size_t i = 0; i < moved.size(); ++i) {
        before = std::max(before, (slid.smooth[i] - slid.feet[i]).norm());
        after = std::max(after, (moved[i] - slid.feet[i]).norm());
    }
    EXPECT_GT(before, 0.04);
    // A tenth of the way inwards is left alone, and tangents are no arcs: 0.01 + 0.045^2 / (2 0.3).
    EXPECT_LT(after, 0.0135);
    const Drift d = drift(slid.mesh.faces, slid.mesh.positions, moved);
    EXPECT_LT(d.tangential_rms, 0.1 * d.normal_rms);  // 0.3 before; below 0.1 a vertex is left alone
}

TEST(Slide, NormalsThatCancelTakeNothingOfTheWay) {
    Slid slid;
    for (std::size_t i = 0; i < slid.mesh.faces.size(); i += 2) std::swap(slid.mesh.faces[i][1], slid.mesh.faces[i][2]);
    const Positions moved = slid.back();
    for (std::size_t i = 0; i < moved.size(); ++i)
        EXPECT_LT((moved[i] - slid.feet[i]).norm(), 0.05) << i;  // none went back outwards by the tenth
}

TEST(Slide, LittleDriftIsLeftAlone) {
    const Slid slid;
    Positions moved = slid.feet;
    slide_back(slid.mesh, stiffness(slid.mesh), slid.smooth, moved);
    EXPECT_EQ(moved, slid.feet);
}

TEST(Slide, FingersThatACutoffTakesAwayDriftLessAndDoNotCrease) {
    Mesh mesh = shapes::irregular_sphere(8000, {0.3, 0.3, 5});
    const std::array<Vec3, 3> tips{Vec3(1, 0, 0), Vec3(-0.5, 0.8, 0.3).normalized(),
                                   Vec3(-0.3, -0.6, -0.7).normalized()};
    for (Vec3& p : mesh.positions) {
        double height = 0;
        for (const Vec3& tip : tips) height += 0.8 * std::exp(-(p - tip).squaredNorm() / 0.04);
        p *= 1 + height;
    }
    const Spline spline(mesh, {}, {});
    const Positions after = spline.low_pass(mesh, {LowPassOrder::second, 30 * spline.mean_edge()}, "cutoff", {});
    const Drift d = drift(mesh.faces, mesh.positions, after);
    EXPECT_LT(d.tangential_rms, 0.13 * d.normal_rms);  // 0.17 without slide_back()
    EXPECT_LE(sharp_edges(mesh.faces, after), 50);     // 58 without, 67 if only folds are avoided
}

// Perpendicular faces are not turned against each other by rounding.
TEST(Directions, AreThoseOfTheOrientationUnlessThatContradictsItself) {
    const Mesh block = shapes::block(4);
    const Array<Vec3> normal = vertex_normals(block.faces, block.positions);
    Array<Vec3> area(block.positions.size(), Vec3::Zero());
    for (const Face& f : block.faces)
        for (const Index v : f) area[v] += area_vector(f, block.positions);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    Positions turned = block.positions;
    for (Vec3& p : turned) p = turn * p;
    const Array<Vec3> here = directions(block.faces, block.positions), there = directions(block.faces, turned);
    for (std::size_t v = 0; v < normal.size(); ++v) {
        EXPECT_NEAR(here[v].dot(area[v].normalized()), 1, 1e-12);
        EXPECT_NEAR((turn * here[v] - there[v]).norm(), 0, 1e-9);
    }
    Mesh mixed = shapes::irregular_sphere(500);
    for (std::size_t f = 0; f < mixed.faces.size(); f += 2) std::swap(mixed.faces[f][0], mixed.faces[f][1]);
    const Array<Vec3> of_mixed = directions(mixed.faces, mixed.positions);
    for (std::size_t v = 0; v < of_mixed.size(); ++v)
        EXPECT_GT(std::abs(of_mixed[v].dot(mixed.positions[v].normalized())), 0.8);
}

}  // namespace multires
