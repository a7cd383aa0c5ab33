#include "filters/analysis/roughness.h"

#include "filter_fixtures.h"
#include "fixtures.h"
#include "measure/measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace multires {

using namespace fixtures;

namespace {

const char* const parameters[] = {"sa", "sq", "sp", "sv", "sz", "ssk", "sku", "sdq", "sdr"};

using Texture2 = std::function<double(double, double)>;

/// A height map over the unit square.
Mesh height_map(Index n, const Texture2& z, const shapes::Irregular& irregular) {
    Mesh mesh = shapes::plane(n, irregular);
    for (Vec3& p : mesh.positions) p.z() = z(p.x(), p.y());
    return mesh;
}

constexpr shapes::Irregular regular{0, 0, 1};

double sine(double x, double /*y*/) { return 0.01 * std::sin(2 * pi * 5 * x); }

/// Forty waves of a tenth to a quarter of the square in all directions, deeper than high.
double pits(double x, double y) {
    shapes::Random random(7);
    double sum = 0;
    for (int i = 0; i < 40; ++i) {
        const double angle = random.uniform(0, 2 * pi), k = 2 * pi / random.uniform(0.1, 0.25);
        sum += std::cos(k * (std::cos(angle) * x + std::sin(angle) * y) + random.uniform(0, 2 * pi));
    }
    return 0.0008 * (sum - 0.05 * sum * sum);
}

/// The height map rolled up around the x axis.
Mesh rolled(Mesh mesh, double radius) {
    for (Vec3& p : mesh.positions) {
        const double angle = p.y() / radius, r = radius + p.z();
        p = {p.x(), r * std::sin(angle), r * std::cos(angle)};
    }
    return mesh;
}

Report measured(const Layer& layer, const RoughnessOptions& options) {
    Session session;
    return roughness(layer, options, session).report;
}

RoughnessOptions over(RoughnessForm form, double s_filter = 0, double l_filter = 0) {
    RoughnessOptions o;
    o.form = form, o.s_filter = s_filter, o.l_filter = l_filter;
    return o;
}

void expect_alike(const Report& a, const Report& b, double share) {
    for (const char* name : parameters)
        EXPECT_NEAR(number(a, name), number(b, name), share * std::abs(number(a, name))) << name;
}

std::string refusal(const Layer& layer, const RoughnessOptions& options) {
    return fixtures::refusal([&] { measured(layer, options); });
}

}  // namespace

TEST(Roughness, OfASineAsByFormula) {
    const double q = 2 * pi * 5, a = 0.01;
    for (const auto& irregular : {regular, shapes::Irregular()}) {
        const Report r = measured(layer_of(height_map(200, sine, irregular)), over(RoughnessForm::none));
        EXPECT_NEAR(number(r, "area"), 1, 1e-9);
        EXPECT_NEAR(number(r, "sa"), 2 * a / pi, 0.01 * a);
        EXPECT_NEAR(number(r, "sq"), a / std::sqrt(2), 0.01 * a);
        EXPECT_NEAR(number(r, "sp"), a, 0.01 * a);
        EXPECT_NEAR(number(r, "sv"), a, 0.01 * a);
        EXPECT_NEAR(number(r, "ssk"), 0, 0.01);
        EXPECT_NEAR(number(r, "sku"), 1.5, 0.015);
        EXPECT_NEAR(number(r, "sdq"), a * q / std::sqrt(2), 0.01 * a * q);
        EXPECT_NEAR(number(r, "sdr"), 100 * a * a * q * q / 4, 0.04 * 100 * a * a * q * q / 4);  // to second order
    }
}

TEST(Roughness, TheHistogramHoldsTheWholeArea) {
    const Report r = measured(layer_of(height_map(60, pits, {})), over(RoughnessForm::plane));
    const std::vector<double> heights = series(r, "heights"), shares = series(r, "shares");
    ASSERT_EQ(heights.size(), shares.size() + 1);
    double sum = 0, mean = 0;
    for (std::size_t i = 0; i < shares.size(); ++i)
        sum += shares[i], mean += shares[i] * 0.5 * (heights[i] + heights[i + 1]);
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(mean, 0, 0.01 * number(r, "sz"));
    EXPECT_DOUBLE_EQ(heights.back() - heights.front(), number(r, "sz"));
}

TEST(Roughness, RegularAndIrregularTrianglesGiveTheSame) {
    for (const RoughnessForm form : {RoughnessForm::plane, RoughnessForm::low_pass}) {
        const auto options = over(form, 0.04, 0.5);
        const Report a = measured(layer_of(height_map(160, pits, regular)), options);
        expect_alike(a, measured(layer_of(height_map(160, pits, {})), options), 0.02);
        // Twice as dense on one half.
        Mesh graded = shapes::plane(160, {});
        for (Vec3& p : graded.positions) {
            p.x() = p.x() < 2.0 / 3 ? 0.75 * p.x() : 0.5 + 1.5 * (p.x() - 2.0 / 3);
            p.z() = pits(p.x(), p.y());
        }
        expect_alike(a, measured(layer_of(std::move(graded)), options), 0.02);
    }
}

TEST(Roughness, ARolledTextureIsThatOfTheFlatOne) {
    const double cutoff = 0.2;
    const Mesh flat = height_map(160, pits, {});
    const Layer curved = layer_of(Motion()(rolled(flat, 20 * cutoff)));
    const Report plane = measured(layer_of(flat), over(RoughnessForm::plane, 0.05, cutoff));
    const Report cylinder = measured(curved, over(RoughnessForm::cylinder, 0.05, cutoff));
    EXPECT_NEAR(number(cylinder, "form_radius"), 20 * cutoff, 0.2 * cutoff);
    expect_alike(plane, cylinder, 0.02);
    const auto low_pass = over(RoughnessForm::low_pass, 0.05, cutoff);
    const Report low = measured(layer_of(flat), low_pass);
    EXPECT_NEAR(number(low, "area"), 0.8 * 0.8, 0.02);
    expect_alike(low, measured(curved, low_pass), 0.01);
}

TEST(Roughness, OverTheLowPassIsAsOverTheFormAwayFromTheRim) {
    // Waves that end at the rim with a right angle, and as often at the strip that does not count.
    const auto tiles = [](double x, double y) {
        return 0.004 * (std::cos(20 * pi * x) * std::cos(10 * pi * y) + std::cos(10 * pi * x));
    };
    const Layer layer = layer_of(height_map(160, tiles, {}));
    const auto sq = [&](RoughnessForm form) { return number(measured(layer, over(form, 0, 0.2)), "sq"); };
    EXPECT_NEAR(sq(RoughnessForm::low_pass), sq(RoughnessForm::plane), 0.02 * sq(RoughnessForm::plane));
}

TEST(Roughness, FormsAreFoundWherever) {
    const auto sphere = shapes::banded_sphere({20000, 30, 60, 0.002, 0.001});
    const Motion motion{Motion().rotation, 7, Motion().offset};
    const Layer layer = layer_of(motion(sphere.mesh));
    const Report ball = measured(layer, over(RoughnessForm::sphere));
    EXPECT_NEAR(number(ball, "form_radius"), 7, 1e-3);
    EXPECT_NEAR(number(ball, "sq"), 7 * std::hypot(0.002, 0.001), 1e-3);
    Mesh tube = shapes::open_cylinder(200, 100);
    for (Vec3& p : tube.positions) {
        const double r = 1 + 0.01 * std::cos(12 * pi * p.z());
        p.x() *= r, p.y() *= r;
    }
    const Report pipe = measured(layer_of(motion(tube)), over(RoughnessForm::cylinder));
    EXPECT_NEAR(number(pipe, "form_radius"), 7, 1e-2);
    EXPECT_NEAR(number(pipe, "sq"), 0.07 / std::sqrt(2), 2e-3);
    Mesh slope = height_map(100, sine, {});
    const Report plane = measured(layer_of(motion(slope)), over(RoughnessForm::plane));
    EXPECT_NEAR(number(plane, "sq"), 0.07 / std::sqrt(2), 2e-3);
}

TEST(Roughness, PeaksAreWhatFacesLookTo) {
    Mesh mesh = height_map(80, pits, {});
    for (const RoughnessForm form : {RoughnessForm::plane, RoughnessForm::low_pass}) {
        const Report out = measured(layer_of(mesh), over(form, 0, 0.4));
        Mesh turned = mesh;
        for (Face& f : turned.faces) std::swap(f[0], f[1]);
        const Report in = measured(layer_of(turned), over(form, 0, 0.4));
        EXPECT_LT(number(out, "ssk"), -0.1);
        EXPECT_NEAR(number(in, "ssk"), -number(out, "ssk"), 1e-6);
        EXPECT_NEAR(number(in, "sp"), number(out, "sv"), 1e-8);
        EXPECT_NEAR(number(in, "sq"), number(out, "sq"), 1e-8);
    }
}

TEST(Roughness, FiltersSeparateTheScales) {
    const auto two = [](double x, double y) {
        return 0.004 * std::cos(2 * pi * 4 * x) + 0.001 * std::cos(2 * pi * 40 * y);
    };
    const Layer layer = layer_of(height_map(200, two, {}));
    for (const RoughnessForm form : {RoughnessForm::plane, RoughnessForm::low_pass}) {
        const double fine = number(measured(layer, over(form, 0, 0.08)), "sq");
        EXPECT_NEAR(fine, 0.001 / std::sqrt(2), 0.1 * 0.001);
        const double coarse = number(measured(layer, over(form, 0.08, 0.5)), "sq");
        const auto passes = [](double cutoff) { return transmission(LowPassOrder::gaussian, cutoff, 0.25); };
        EXPECT_NEAR(coarse, 0.004 / std::sqrt(2) * (passes(0.08) - passes(0.5)), 0.02 * 0.004);
    }
}

TEST(Roughness, OfASelectionOnly) {
    Mesh mesh = height_map(
        200, [](double x, double y) { return x < 0.5 ? sine(x, y) : 0.3 * (x - 0.5); }, regular);
    Layer layer = layer_of(mesh);
    for (const Vec3& p : mesh.positions) layer.selected_vertex.push_back(p.x() <= 0.4 + 1e-9);
    RoughnessOptions o = over(RoughnessForm::none);
    o.selected = true;
    const Report r = measured(layer, o);
    EXPECT_NEAR(number(r, "sq"), 0.01 / std::sqrt(2), 2e-4);
    EXPECT_NEAR(number(r, "area"), 0.4, 0.01);
}

TEST(Roughness, RefusesWhatCannotBeMeasured) {
    const Layer sphere = layer_of(shapes::irregular_sphere(2000));
    const double edge = mean_edge_length(sphere.mesh.faces, sphere.mesh.positions), nan = std::nan("");
    const auto says = [&](const RoughnessOptions& o, const char* what, const Layer* layer = nullptr) {
        EXPECT_NE(refusal(layer ? *layer : sphere, o).find(what), std::string::npos)
            << what << ": " << refusal(layer ? *layer : sphere, o);
    };
    says(over(RoughnessForm::low_pass, 0, 0), "l_filter must be more than 0");
    says(over(RoughnessForm::low_pass, 0, edge), "l_filter must be at least two mean edges");
    says(over(RoughnessForm::low_pass, edge, 8 * edge), "s_filter must be at least two mean edges");
    says(over(RoughnessForm::sphere, 9 * edge, 8 * edge), "l_filter must be more than s_filter");
    says(over(RoughnessForm::sphere, nan, 8 * edge), "s_filter must be a number");
    says(over(RoughnessForm::sphere, 0, -1), "l_filter must be a number");
    for (const RoughnessForm form : {RoughnessForm::none, RoughnessForm::plane, RoughnessForm::cylinder})
        says(over(form), "form: ");
    const Layer flat = layer_of(shapes::plane(20));
    says(over(RoughnessForm::sphere), "form: a sphere does not fit", &flat);
    says(over(RoughnessForm::cylinder), "form: a cylinder does not fit", &flat);
    RoughnessOptions none = over(RoughnessForm::plane);
    none.selected = true;
    says(none, "selected: nothing is selected", &flat);
    Layer one = flat;
    one.selected_vertex.assign(flat.mesh.positions.size(), 0);
    one.selected_vertex[30] = 1;
    says(none, "selected: no face", &one);
}

TEST(Roughness, EveryClassOfMeshIsMeasuredOrRefused) {
    for (const auto& [name, mesh] : every_class())
        for (const RoughnessForm form : {RoughnessForm::none, RoughnessForm::plane, RoughnessForm::sphere,
                                         RoughnessForm::cylinder, RoughnessForm::low_pass}) {
            const Layer layer = layer_of(mesh);
            Session session;
            const double edge = mean_edge_length(mesh.faces, mesh.positions);
            try {
                const Report r = roughness(layer, over(form, 3 * edge, 8 * edge), session).report;
                for (const char* p : parameters) EXPECT_TRUE(std::isfinite(number(r, p))) << name << ' ' << p;
            } catch (const InputError& e) {
                const std::string said = e.what();
                EXPECT_EQ(said.find("form: "), 0u) << name << ": " << e.what();
            }
        }
}

}  // namespace multires
