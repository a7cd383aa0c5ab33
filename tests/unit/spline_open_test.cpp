#include "bands/spline.h"
#include "base/angles.h"
#include "fixtures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

/// Transmission of the calibrated filter on an open half sphere and on tori, of uneven triangles.
namespace multires {

namespace {

/// A Moebius map of the unit sphere: spacing from 1 to 2 from pole to pole, density from 4 to 1.
void grade(Positions& sphere) {
    for (Vec3& p : sphere) {
        const double x = std::sqrt(2.0) * p.x() / (1 - 0.999999 * p.z());
        const double y = std::sqrt(2.0) * p.y() / (1 - 0.999999 * p.z());
        p = Vec3(2 * x, 2 * y, x * x + y * y - 1) / (x * x + y * y + 1);
    }
}

/// The faces whose vertices have x > 0.
Mesh half(const Mesh& sphere) {
    Mesh out;
    std::vector<Index> number(sphere.positions.size(), -1);
    for (Face f : sphere.faces) {
        if (std::any_of(f.begin(), f.end(), [&](Index v) { return sphere.positions[v].x() <= 0; })) continue;
        for (Index& v : f) {
            if (number[v] < 0) {
                number[v] = static_cast<Index>(out.positions.size());
                out.positions.push_back(sphere.positions[v]);
            }
            v = number[v];
        }
        out.faces.push_back(f);
    }
    return out;
}

/// A harmonic that is its own mirror image at x = 0, so that it has natural conditions at the rim.
Array<double> even_harmonic(const Positions& p, Index degree, std::uint64_t seed) {
    Positions mirrored = p;
    for (Vec3& q : mirrored) q.x() = -q.x();
    const std::vector<double> a = shapes::harmonic(p, degree, seed), b = shapes::harmonic(mirrored, degree, seed);
    Array<double> sum(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) sum[i] = a[i] + b[i];
    return sum;
}

/// Density up to 4 times as high on one side; a fifth of the edges turned.
Mesh uneven_torus(Index around, Index across) {
    Mesh mesh = shapes::torus(around, across, 1, 0.4);
    for (Vec3& p : mesh.positions) {
        const double t = std::atan2(p.y(), p.x()), u = t + std::sin(t) / 3;
        const double r = std::hypot(p.x(), p.y());
        p = Vec3(r * std::cos(u), r * std::sin(u), p.z());
    }
    shapes::flip_edges(mesh, 0.2, 4);
    return mesh;
}

constexpr LowPassOrder orders[] = {LowPassOrder::first, LowPassOrder::second, LowPassOrder::fourth,
                                   LowPassOrder::gaussian};

}  // namespace

TEST(SplineOpen, TransmissionOnAHalfSphereIsTheFormulaAwayFromTheRim) {
    for (const bool graded : {false, true}) {
        Mesh sphere = shapes::irregular_sphere(12000, {0.3, 0.3, 7});
        if (graded) grade(sphere.positions);
        const Mesh mesh = half(sphere);
        const Spline spline(mesh, {}, {});
        for (const double edges : {4.0, 10.0, 30.0}) {
            const Index degree = static_cast<Index>(std::lround(2 * pi / (edges * spline.mean_edge()) - 0.5));
            const double wave = 2 * pi / std::sqrt(degree * (degree + 1.0));
            const Array<double> f = even_harmonic(mesh.positions, degree, 3);
            Array<double> g(f.size());
            for (const LowPassOrder order : orders) {
                spline.low_pass({order, wave}, ConstRows(f, 1), Rows(g, 1), "cutoff", {});
                double along = 0, norm = 0;
                for (std::size_t i = 0; i < f.size(); ++i) {
                    if (mesh.positions[i].x() < wave / 2) continue;
                    along += spline.solver().matrices().mass[i] * f[i] * g[i];
                    norm += spline.solver().matrices().mass[i] * f[i] * f[i];
                }
                EXPECT_NEAR(along / norm, 0.5, 0.02) << edges << (graded ? ", graded" : "");
            }
        }
    }
}

TEST(SplineOpen, TransmissionOnAnUnevenTorusIsTheFormula) {
    // So fine that the tube hardly bends within a wave: the test waves are plane.
    const Mesh mesh = uneven_torus(280, 112);
    const Spline spline(mesh, {}, {});
    for (const double edges : {4.0, 6.0})
        for (const LowPassOrder order : orders) {
            const double cutoff = edges * spline.mean_edge();
            const auto measured = measure_transmission(spline, mesh, {order, cutoff}, {cutoff, 1.5 * cutoff}, {});
            ASSERT_EQ(measured.size(), 2U);
            for (const MeasuredTransmission& m : measured)
                EXPECT_NEAR(m.measured, m.formula, 0.02) << edges << ", " << m.wave / cutoff;
        }
}

}  // namespace multires
