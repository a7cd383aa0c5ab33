#include "bands/directions.h"
#include "bands/spline.h"
#include "base/angles.h"
#include "base/error.h"
#include "fixtures.h"
#include "measure/measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace multires {

using namespace fixtures;

namespace {

constexpr LowPassOrder orders[] = {LowPassOrder::first, LowPassOrder::second, LowPassOrder::fourth,
                                   LowPassOrder::gaussian};

/// Share of f in g where `in` holds, by mass.
template <class In>
double share(const Spline& spline, const Array<double>& f, const Array<double>& g, const In& in) {
    double along = 0, norm = 0;
    for (std::size_t i = 0; i < f.size(); ++i)
        if (in(i)) {
            along += spline.solver().matrices().mass[i] * f[i] * g[i];
            norm += spline.solver().matrices().mass[i] * f[i] * f[i];
        }
    return along / norm;
}

/// 9 times the density at one end.
Mesh graded(Mesh mesh) {
    for (Vec3& p : mesh.positions) {
        p.x() = p.x() / 3 + p.x() * p.x() / 3;  // spacing from 1/3 to 1
        p.y() *= 2.0 / 3;
    }
    return mesh;
}

/// Triangles of that aspect, all along one axis, and far from Delaunay.
Mesh stretched(Mesh mesh, double aspect) {
    for (Vec3& p : mesh.positions) p.x() *= aspect;
    return mesh;
}

std::vector<std::pair<std::string, Mesh>> planes() {
    return {{"regular", shapes::plane(80, {0, 0, 1})},
            {"irregular", shapes::plane(80, {0.3, 0.3, 2})},
            {"graded", graded(shapes::plane(110, {0.25, 0.2, 4}))},
            {"stretched", stretched(shapes::plane(100, {0.3, 0.3, 2}), 5)}};
}

/// Three half planes that meet in the line y = 1/2, z = 0; n even.
Mesh three_half_planes(Index n) {
    Mesh mesh = shapes::plane(n, {0, 0, 1});
    std::vector<Index> last, next;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (std::abs(mesh.positions[i].y() - 0.5) < 1e-9) last.push_back(static_cast<Index>(i));
    std::sort(last.begin(), last.end(),
              [&](Index a, Index b) { return mesh.positions[a].x() < mesh.positions[b].x(); });
    for (Index row = 1; row <= n / 2; ++row) {
        next.clear();
        for (const Index i : last) {
            const double x = mesh.positions[i].x();
            next.push_back(static_cast<Index>(mesh.positions.size()));
            mesh.positions.emplace_back(x, 0.5, static_cast<double>(row) / n);
        }
        for (std::size_t i = 0; i + 1 < last.size(); ++i) {
            mesh.faces.push_back({last[i], last[i + 1], next[i + 1]});
            mesh.faces.push_back({last[i], next[i + 1], next[i]});
        }
        last = next;
    }
    return mesh;
}

/// Share of a wave of the length of the cutoff, cosine and sine of `phase`, where `in` holds.
template <class Phase, class In>
double share_at_cutoff(const Spline& spline, const Mesh& mesh, double cutoff, const Phase& phase, const In& in) {
    double along = 0, norm = 0;
    for (const double shift : {0.0, pi / 2}) {
        Array<double> f(mesh.positions.size()), g(f.size());
        for (std::size_t i = 0; i < f.size(); ++i) f[i] = std::cos(2 * pi / cutoff * phase(mesh.positions[i]) + shift);
        spline.low_pass({LowPassOrder::second, cutoff}, ConstRows(f, 1), Rows(g, 1), "cutoff", {});
        for (std::size_t i = 0; i < f.size(); ++i)
            if (in(mesh.positions[i])) {
                along += spline.solver().matrices().mass[i] * f[i] * g[i];
                norm += spline.solver().matrices().mass[i] * f[i] * f[i];
            }
    }
    return along / norm;
}

/// Of the harmonic on the unit sphere whose waves have so many mean edges.
Index degree_of(double edges, const Spline& spline) {
    return static_cast<Index>(std::lround(2 * pi / (edges * spline.mean_edge()) - 0.5));
}

/// All orders pass what the formula says of a harmonic on a unit sphere, at cutoffs about its wavelength.
void expect_transmission(const Spline& spline, const Mesh& sphere, Index degree, Index order_m, double tolerance) {
    const double wave = 2 * pi / std::sqrt(degree * (degree + 1.0));
    const std::vector<double> h = shapes::harmonic(sphere.positions, degree, order_m);
    const Array<double> f(h.begin(), h.end());
    Array<double> g(f.size());
    for (const LowPassOrder order : orders)
        for (const double ratio : {0.8, 1.0, 1.25}) {
            spline.low_pass({order, wave * ratio}, ConstRows(f, 1), Rows(g, 1), "cutoff", {});
            EXPECT_NEAR(share(spline, f, g, [](std::size_t) { return true; }), transmission(order, wave * ratio, wave),
                        tolerance)
                << "degree " << degree << ", " << ratio;
        }
}

}  // namespace

TEST(Transmission, TermsSumToTheFormulaAndLeaveConstants) {
    for (const LowPassOrder order : orders) {
        const double limit = order == LowPassOrder::gaussian ? 1.5e-4 : 1e-14;
        EXPECT_NEAR(transmission(order, 2, 2), 0.5, 1e-15);
        for (double wave = 1e-3; wave < 1e3; wave *= 1.01) {
            double sum = 0;
            const double s = 1 / (wave * wave);
            for (const Term& t : terms(order)) sum += (t.weight / (s + t.pole)).real();
            EXPECT_NEAR(sum, transmission(order, 1, wave), limit) << wave;
        }
        double constant = 0;
        for (const Term& t : terms(order)) constant += (t.weight / t.pole).real();
        EXPECT_NEAR(constant, 1, 1e-13);
    }
}

TEST(Spline, SpreadMassesSumToTheArea) {
    for (const auto& [name, mesh] : every_class()) {
        const Stiffness c = stiffness(mesh, {1e-7, true});
        const Stiffness plain = stiffness(mesh);
        ASSERT_EQ(c.weight, plain.weight) << name;
        ASSERT_EQ(c.mass, plain.mass) << name;
        EXPECT_TRUE(plain.mass_weight.empty());
        Array<double> ones(mesh.positions.size(), 1), out(ones.size());
        apply_mass(c, ones.data(), 1, out.data());
        EXPECT_EQ(out, c.mass) << name;
    }
}

TEST(Spline, TransmissionOfPlaneWavesIsTheFormulaAwayFromTheRim) {
    for (const auto& [name, plane] : planes()) {
        const Mesh& mesh = plane;  // lambdas cannot capture structured bindings
        const Spline spline(mesh, {}, {});
        const Box box = bounding_box(mesh.positions);
        for (const double edges : {4.0, 6.0, 10.0, 20.0})
            for (const LowPassOrder order : orders) {
                const double cutoff = edges * spline.mean_edge();
                // The wave length of a lattice depends on the direction.
                const double limit = name == "regular" && edges == 4 ? 0.035 : 0.02;
                for (const double ratio : {1.0, 2.0}) {
                    const double wave = cutoff * ratio;
                    if (wave > (box.high - box.low).head<2>().minCoeff()) continue;  // all of it is near the rim
                    Array<double> f(mesh.positions.size()), g(f.size());
                    for (const double angle : {0.2, 1.1, 1.5, 2.6}) {
                        for (std::size_t i = 0; i < f.size(); ++i) {
                            const Vec3& p = mesh.positions[i];
                            f[i] = std::cos(2 * pi / wave * (p.x() * std::cos(angle) + p.y() * std::sin(angle)));
                        }
                        spline.low_pass({order, cutoff}, ConstRows(f, 1), Rows(g, 1), "cutoff", {});
                        const double rim = std::min(1.0 * cutoff, 0.3);
                        const double found = share(spline, f, g, [&](std::size_t i) {
                            const Vec3 &p = mesh.positions[i], a = p - box.low, b = box.high - p;
                            return std::min({a.x(), a.y(), b.x(), b.y()}) > rim;
                        });
                        EXPECT_NEAR(found, transmission(order, cutoff, wave), limit)
                            << name << ", " << edges << " edges, order " << static_cast<int>(order) << ", wave x "
                            << ratio << ", angle " << angle;
                    }
                }
            }
    }
}

TEST(Spline, AtTheRimWavesAreFilteredAsTheirMirrorImagesExactly) {
    // u + u''''/k^4 = sin(k x + phase) for x > 0 with the natural conditions u'(0) = u'''(0) = 0 is solved by half of
    // the wave and, for its kink in the mirror at x = 0, a term that dies out: nothing if the rim is at its crest.
    const Mesh mesh = shapes::plane(80, {0.3, 0.3, 2});
    const Spline spline(mesh, {}, {});
    for (const double edges : {6.0, 12.0, 20.0})
        for (const double phase : {0.0, pi / 4, pi / 2}) {
            const double cutoff = edges * spline.mean_edge(), k = 2 * pi / cutoff;
            Array<double> f(mesh.positions.size()), g(f.size());
            for (std::size_t i = 0; i < f.size(); ++i) f[i] = std::sin(k * mesh.positions[i].x() + phase);
            spline.low_pass({LowPassOrder::second, cutoff}, ConstRows(f, 1), Rows(g, 1), "cutoff", {});
            double along = 0, norm = 0, error = 0;
            for (std::size_t i = 0; i < f.size(); ++i) {
                const Vec3& p = mesh.positions[i];
                if (p.x() > cutoff / 2 || std::min(p.y(), 1 - p.y()) < cutoff) continue;
                const double s = k * p.x() / std::sqrt(2.0);
                const double kink = std::cos(phase) / std::sqrt(2.0) * std::exp(-s) * std::cos(s);
                error += std::pow(g[i] - f[i] / 2 - kink, 2);
                along += f[i] * g[i], norm += f[i] * f[i];
            }
            // The kink holds waves that are too short for six edges.
            EXPECT_LT(std::sqrt(error / norm), edges < 10 ? 0.05 : 0.02) << edges << ", " << phase;
            if (phase == pi / 2) {
                EXPECT_NEAR(along / norm, 0.5, 0.02) << edges;
            }
        }
}

TEST(Spline, TransmissionWhereThreeSheetsMeetIsTheFormula) {
    const Mesh mesh = three_half_planes(60);
    const Spline spline(mesh, {}, {});
    for (const double edges : {6.0, 12.0}) {
        const double cutoff = edges * spline.mean_edge();
        const auto near = [&](const Vec3& p) {
            return std::abs(p.y() - 0.5) + p.z() < cutoff / 2 && std::min(p.x(), 1 - p.x()) > cutoff;
        };
        EXPECT_NEAR(share_at_cutoff(
                        spline, mesh, cutoff, [](const Vec3& p) { return p.x(); }, near),
                    0.5, 0.02);
        EXPECT_NEAR(share_at_cutoff(
                        spline, mesh, cutoff, [](const Vec3& p) { return p.y() - 0.5 + p.z(); }, near),
                    0.5, 0.02);
    }
}

TEST(Spline, TransmissionOnTheTorusIsTheFormula) {
    const Mesh mesh = shapes::torus(220, 90);
    const Spline spline(mesh, {}, {});
    const double cutoff = 12 * spline.mean_edge();
    for (const LowPassOrder order : {LowPassOrder::first, LowPassOrder::second, LowPassOrder::gaussian}) {
        const auto measured = measure_transmission(spline, mesh, {order, cutoff},
                                                   {cutoff / 3, cutoff / 1.4, cutoff, 1.4 * cutoff, 3 * cutoff}, {});
        ASSERT_EQ(measured.size(), 5U);
        for (const MeasuredTransmission& m : measured) EXPECT_NEAR(m.measured, m.formula, 0.02) << m.wave;
    }
}

TEST(Spline, ScansDoNotDrift) {
    const Mesh mesh = shapes::scan(20000);
    const Spline spline(mesh, {}, {});
    for (const double edges : {4.0, 12.0, 40.0}) {
        const Positions after = spline.low_pass(mesh, {LowPassOrder::second, edges * spline.mean_edge()}, "cutoff", {});
        const Drift d = drift(mesh.faces, mesh.positions, after);
        EXPECT_LT(d.tangential_rms, 0.02 * d.normal_rms) << edges;
    }
}

TEST(Spline, TransmissionOfHarmonicsOnTheSphereIsTheFormula) {
    for (const double jitter : {0.0, 0.3}) {
        const Mesh mesh = shapes::irregular_sphere(10000, {jitter, jitter, 5});
        const Spline spline(mesh, {}, {});
        for (const Index degree : {3, 10, 25}) {
            const double wave = 2 * pi / std::sqrt(degree * (degree + 1.0));
            const std::vector<double> h = shapes::harmonic(mesh.positions, degree, 3);
            const Array<double> f(h.begin(), h.end());
            Array<double> g(f.size());
            for (const LowPassOrder order : orders)
                for (const double ratio : {0.7, 1.0, 1.5}) {
                    const double cutoff = wave * ratio;
                    spline.low_pass({order, cutoff}, ConstRows(f, 1), Rows(g, 1), "cutoff", {});
                    EXPECT_NEAR(share(spline, f, g, [](std::size_t) { return true; }),
                                transmission(order, cutoff, wave), 0.02)
                        << degree << ", " << ratio;
                }
        }
    }
}

TEST(Spline, SphereStaysASphere) {
    // With flips, three edges in ten are no Delaunay edges: the faces themselves lean.
    struct Case {
        double flips, normals, radial;
    };
    for (const Case& c : {Case{0, 0.07, 1.2e-5}, Case{0.3, 0.08, 1.2e-5}}) {
        const Mesh mesh = shapes::irregular_sphere(40000, {0.3, c.flips, 11});
        const Spline spline(mesh, {}, {});
        for (const double cutoff : {0.1, 0.25, 0.5, 1.0}) {
            const Positions after = spline.low_pass(mesh, {LowPassOrder::second, cutoff}, "cutoff", {});
            double sum = 0, squares = 0, turn = 0, gone = 0, area = 0;
            for (const Vec3& p : after) sum += p.norm();
            for (std::size_t i = 0; i < after.size(); ++i) {
                const double mass = spline.solver().matrices().mass[i];
                gone += mass * (after[i].norm() - mesh.positions[i].norm()), area += mass;
            }
            const double mean = sum / static_cast<double>(after.size());
            for (const Vec3& p : after) squares += std::pow(p.norm() - mean, 2);
            for (const Face& f : mesh.faces) {
                const auto normal = [&](const Positions& p) {
                    return Vec3((p[f[1]] - p[f[0]]).cross(p[f[2]] - p[f[0]]).normalized());
                };
                turn += degrees(std::acos(std::min(1.0, normal(after).dot(normal(mesh.positions)))));
            }
            const double k = 2 * pi / cutoff, expected = 1 / (1 + std::pow(2 / (k * k), 2)) - 1;
            EXPECT_LT(std::sqrt(squares / static_cast<double>(after.size())), c.radial) << cutoff;
            EXPECT_LT(turn / static_cast<double>(mesh.faces.size()), c.normals) << cutoff;
            EXPECT_NEAR(gone / area, expected, 0.02 * std::abs(expected)) << cutoff;  // 2.6e-7 at the least
            const Drift d = drift(mesh.faces, mesh.positions, after);
            EXPECT_LT(d.tangential_rms, 0.01 * d.normal_rms) << cutoff;
        }
    }
}

TEST(Spline, TransmissionOnAGradedSphereIsTheFormula) {
    // A Moebius map of the sphere: spacing from 1 to 2.25 from pole to pole.
    Mesh mesh = shapes::irregular_sphere(10000, {0.3, 0.3, 7});
    for (Vec3& p : mesh.positions) {
        const double x = 1.5 * p.x() / (1 - 0.999999 * p.z()), y = 1.5 * p.y() / (1 - 0.999999 * p.z());
        p = Vec3(2 * x, 2 * y, x * x + y * y - 1) / (x * x + y * y + 1);
    }
    const Spline spline(mesh, {}, {});
    for (const double edges : {4.0, 8.0}) {
        const Index degree = degree_of(edges, spline);
        expect_transmission(spline, mesh, degree, 3, 0.02);
    }
}

TEST(Spline, TransmissionOnSpheresOfAnyTrianglesIsTheFormulaFromFourEdgesOn) {
    for (const auto& mesh : {shapes::irregular_sphere(10000, {0.3, 0.3, 7}),
                             shapes::irregular_sphere(10000, {0.4, 0.5, 9}), shapes::icosphere(30)}) {
        const Spline spline(mesh, {}, {});
        for (const double edges : {4.0, 6.0, 10.0}) {
            const Index degree = degree_of(edges, spline);
            expect_transmission(spline, mesh, degree, degree / 2, 0.01);
        }
    }
}

TEST(Spline, PlanarPatchStaysAsItIs) {
    for (const auto& [name, plane] : planes()) {
        const Motion motion;
        const Mesh mesh = motion(plane);
        const Spline spline(mesh, {}, {});
        for (const double edges : {4.0, 20.0}) {
            const Positions after =
                spline.low_pass(mesh, {LowPassOrder::second, edges * spline.mean_edge()}, "cutoff", {});
            double most = 0;
            for (std::size_t i = 0; i < after.size(); ++i) most = std::max(most, (after[i] - mesh.positions[i]).norm());
            EXPECT_LT(most, 1e-4 * spline.mean_edge()) << name << ", " << edges;
        }
    }
}

TEST(Spline, EveryMeshIsFilteredWithoutFoldsOrNumbersThatAreNotFinite) {
    for (const auto& [name, mesh] : every_class()) {
        const Spline spline(mesh, {}, {});
        if (!(spline.mean_edge() > 0)) continue;
        for (const LowPassOrder order : orders)
            for (const double edges : {2.0, 10.0, 1e9}) {
                const Positions after = spline.low_pass(mesh, {order, edges * spline.mean_edge()}, "cutoff", {});
                for (const Vec3& p : after) ASSERT_TRUE(p.allFinite()) << name;
            }
    }
}

TEST(Spline, HeldVerticesKeepTheirPlaces) {
    const Mesh mesh = shapes::scan(2000);
    std::vector<std::uint8_t> held(mesh.positions.size(), 0);
    for (std::size_t i = 0; i < held.size(); i += 5) held[i] = 1;
    const Spline spline(mesh, held, {});
    EXPECT_NE(spline.hash(), spline_hash(mesh, {}));
    EXPECT_EQ(spline.hash(), spline_hash(mesh, held));
    const Positions after = spline.low_pass(mesh, {LowPassOrder::fourth, 5 * spline.mean_edge()}, "cutoff", {});
    for (std::size_t i = 0; i < held.size(); ++i)
        if (held[i]) {
            EXPECT_LT((after[i] - mesh.positions[i]).norm(), 1e-12);
        }
}

TEST(Spline, CutoffsWithoutMeaningAreRefused) {
    const Mesh mesh = shapes::icosphere(6);
    const Spline spline(mesh, {}, {});
    for (const double wavelength : {0.0, -1.0, 1.99 * spline.mean_edge(), std::numeric_limits<double>::infinity(),
                                    std::numeric_limits<double>::quiet_NaN()}) {
        try {
            spline.low_pass(mesh, {LowPassOrder::second, wavelength}, "coarsest", {});
            ADD_FAILURE() << wavelength;
        } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find("coarsest"), std::string::npos);
        }
    }
}

TEST(Spline, SameBitsForAnyNumberOfThreads) {
    const Mesh mesh = shapes::scan(3000);
    const auto run = [&](int threads) {
        const Threads t(threads);
        const Spline spline(mesh, {}, {});
        return spline.low_pass(mesh, {LowPassOrder::gaussian, 10 * spline.mean_edge()}, "cutoff", {});
    };
    EXPECT_EQ(run(1), run(3));
}

TEST(Spline, MeasuredTransmissionIsThatOfTheFormula) {
    const Mesh mesh = shapes::irregular_sphere(10000, {0.3, 0.3, 7});
    const Spline spline(mesh, {}, {});
    const double cutoff = 10 * spline.mean_edge();
    const auto measured =
        measure_transmission(spline, mesh, {LowPassOrder::second, cutoff}, {cutoff / 2, cutoff, 2 * cutoff}, {});
    ASSERT_EQ(measured.size(), 3U);
    for (const MeasuredTransmission& m : measured) EXPECT_NEAR(m.measured, m.formula, 0.02) << m.wave;
}

}  // namespace multires
