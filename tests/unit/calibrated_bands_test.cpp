#include "base/angles.h"
#include "filter_fixtures.h"
#include "filters/attributes/attributes_band.h"
#include "filters/shape/band_filters.h"
#include "fixtures.h"
#include "measure/measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace multires {

using namespace fixtures;

namespace {

template <class Options>
Options calibrated(Options options, LowPassOrder order = LowPassOrder::second) {
    options.calibration.method = BandMethod::spline;
    options.calibration.order = order;
    return options;
}

double edge(const Layer& layer) { return mean_edge_length(layer.mesh.faces, layer.mesh.positions); }

}  // namespace

TEST(CalibratedBands, UnchangedBandsGiveTheMeshBackBitForBit) {
    for (const auto& [name, mesh] : every_class()) {
        const Layer layer = layer_of(mesh);
        Session session;
        auto band = calibrated(BandOptions());
        band.band.coarsest = 8 * edge(layer), band.band.finest = 4 * edge(layer), band.gain = 1;
        EXPECT_EQ(*scale_band(layer, band, session).positions, mesh.positions) << name;
        EXPECT_EQ(*equalizer(layer, calibrated(EqualizerOptions()), session).positions, mesh.positions) << name;
    }
}

TEST(CalibratedBands, BandsAreDifferencesOfLowPasses) {
    const Layer layer = layer_of(shapes::scan(3000));
    Session session;
    const auto low = [&](double cutoff) {
        auto o = calibrated(LowPassOptions());
        o.cutoff = cutoff;
        return *low_pass(layer, o, session).positions;
    };
    const double fine = 5 * edge(layer), coarse = 12 * edge(layer);
    const Positions a = low(fine), b = low(coarse);
    auto band = calibrated(BandOptions());
    band.band.finest = fine, band.band.coarsest = coarse;
    for (const double gain : {0.0, 0.5, 3.0}) {
        band.gain = gain;
        const Positions after = *scale_band(layer, band, session).positions;
        for (std::size_t i = 0; i < after.size(); ++i)
            ASSERT_LT((after[i] - (layer.mesh.positions[i] + (gain - 1) * (a[i] - b[i]))).norm(), 1e-14);
    }
    band.band.finest = 0, band.gain = 0;
    const Positions all = *scale_band(layer, band, session).positions;
    for (std::size_t i = 0; i < all.size(); ++i) ASSERT_LT((all[i] - b[i]).norm(), 1e-14);
}

TEST(CalibratedBands, EqualizerOfZeroFineGainsIsTheLowPassAtTheirLimit) {
    const Layer layer = layer_of(shapes::scan(3000));
    Session session;
    auto gains = calibrated(EqualizerOptions());
    gains.gain = {0, 0, 0, 1, 1, 1, 1, 1};
    auto low = calibrated(LowPassOptions());
    low.cutoff = equalizer_limits(layer, gains.pyramid)[3];
    EXPECT_EQ(*equalizer(layer, gains, session).positions, *low_pass(layer, low, session).positions);
}

TEST(CalibratedBands, SolverIsKeptWithTheMeshAndNeverUsedForAnother) {
    Layer layer = layer_of(shapes::scan(1500));
    auto o = calibrated(LowPassOptions());
    o.cutoff = 6 * edge(layer);
    Session session;
    const Positions first = *low_pass(layer, o, session).positions;
    const auto kept = session.spline;
    EXPECT_TRUE(session.pyramids.all().empty());
    o.cutoff *= 2, o.calibration.order = LowPassOrder::gaussian;
    low_pass(layer, o, session);
    EXPECT_EQ(session.spline, kept);
    layer.mesh.positions[7].x() += 1e-9;
    low_pass(layer, o, session);
    EXPECT_NE(session.spline, kept);
    o.pyramid.features.from = Features::angle;
    o.pyramid.features.angle = 20;
    const auto moved = session.spline;
    low_pass(layer, o, session);
    EXPECT_NE(session.spline, moved);
}

TEST(CalibratedBands, NothingIsSmoothedAcrossFeatures) {
    // Noise on one side of the crease does not reach the other: the plane there stays as it is.
    Layer layer = layer_of(shapes::block(8, {0.2, 0, 3}));
    auto o = calibrated(LowPassOptions(), LowPassOrder::first);
    o.cutoff = 10 * edge(layer);
    o.pyramid.features.from = Features::angle;
    o.pyramid.features.angle = 30;
    Session session;
    const Positions before = layer.mesh.positions;
    const Positions after = *low_pass(layer, o, session).positions;
    int corners = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const bool bottom = std::abs(before[i].z() - layer.mesh.positions[0].z()) < 1e-12;
        corners += bottom;
        if (bottom) {
            EXPECT_NEAR(after[i].z(), before[i].z(), 1e-9);
        }
    }
    EXPECT_GT(corners, 10);
}

TEST(CalibratedBands, EveryUnitMeansTheSameWavelength) {
    const Layer layer = layer_of(shapes::scan(4000));
    Session session;
    auto o = calibrated(LowPassOptions());
    o.unit = Unit::level, o.cutoff = 3;
    const Positions by_level = *low_pass(layer, o, session).positions;
    ASSERT_FALSE(session.pyramids.all().empty());
    o.unit = Unit::vertices, o.cutoff = session.pyramids.all().front()->levels()[3].vertices;
    const Positions by_vertices = *low_pass(layer, o, session).positions;
    o.unit = Unit::wavelength, o.cutoff = session.pyramids.all().front()->levels()[3].wavelength;
    const Positions by_wave = *low_pass(layer, o, session).positions;
    o.unit = Unit::wavelength_percent, o.cutoff *= 100 / box_diagonal(layer);
    const Positions by_percent = *low_pass(layer, o, session).positions;
    for (std::size_t i = 0; i < by_wave.size(); ++i) {
        ASSERT_LT((by_level[i] - by_wave[i]).norm(), 1e-12);
        ASSERT_LT((by_vertices[i] - by_wave[i]).norm(), 1e-12);
        ASSERT_LT((by_percent[i] - by_wave[i]).norm(), 1e-12);
    }
}

TEST(CalibratedBands, BadLimitsAreErrorsThatNameTheParameter) {
    const Layer layer = layer_of(shapes::scan(1000));
    Session session;
    auto low = calibrated(LowPassOptions());
    for (const double cutoff : {edge(layer), std::nan(""), -1.0, 0.0, HUGE_VAL}) {
        low.cutoff = cutoff;
        EXPECT_NE(refusal([&] { low_pass(layer, low, session); }).find("cutoff"), std::string::npos) << cutoff;
    }
    auto band = calibrated(BandOptions());
    band.band.finest = edge(layer), band.band.coarsest = 8 * edge(layer);
    EXPECT_EQ(refusal([&] { scale_band(layer, band, session); }).find("finest"), 0U);
    band.band.finest = 0, band.band.coarsest = edge(layer);
    EXPECT_EQ(refusal([&] { scale_band(layer, band, session); }).find("coarsest"), 0U);
}

TEST(CalibratedBands, SelectionDecidesWhereItActs) {
    Layer layer = layer_of(shapes::scan(1500));
    layer.selected_vertex.assign(layer.mesh.positions.size(), 0);
    for (std::size_t i = 0; i < 400; ++i) layer.selected_vertex[i] = 1;
    auto o = calibrated(LowPassOptions());
    o.cutoff = 6 * edge(layer);
    Session session;
    const Positions all = *low_pass(layer, o, session).positions;
    o.region.selected = true;
    const Positions part = *low_pass(layer, o, session).positions;
    for (std::size_t i = 0; i < part.size(); ++i)
        EXPECT_EQ(part[i], layer.selected_vertex[i] ? all[i] : layer.mesh.positions[i]);
}

TEST(CalibratedBands, AttributesHaveTheTransmissionOfTheFormulaAndConstantsStay) {
    Layer layer = layer_of(shapes::irregular_sphere(6000, {0.3, 0, 4}));
    const Index degree = 12;
    const double wave = 2 * std::acos(-1.0) / std::sqrt(degree * (degree + 1.0));
    Attribute quality;
    quality.kind = AttributeKind::quality;
    quality.values = shapes::harmonic(layer.mesh.positions, degree, 5);
    layer.attributes = {quality};
    auto o = calibrated(AttributeBandOptions());
    o.what.quality = true;
    for (const LowPassOrder order : {LowPassOrder::first, LowPassOrder::second, LowPassOrder::gaussian}) {
        o.calibration.order = order;
        o.cutoff = 1.3 * wave;
        Session session;
        const std::vector<double> after = filter_attribute_bands(layer, o, session).attributes[0].values;
        double along = 0, norm = 0;
        for (std::size_t i = 0; i < after.size(); ++i) {
            along += after[i] * quality.values[i];
            norm += quality.values[i] * quality.values[i];
        }
        EXPECT_NEAR(along / norm, transmission(order, 1.3, 1), 0.01);
        Layer constant = layer;
        constant.attributes[0].values.assign(after.size(), 1.0 / 3);
        EXPECT_EQ(filter_attribute_bands(constant, o, session).attributes[0].values, constant.attributes[0].values);
    }
}

/// A bar as CAD programs tessellate it: many short edges around its ends, few long ones along it.
Mesh bar() {
    constexpr Index sides = 60;
    Mesh mesh;
    for (const double z : {0.0, 0.1, 10.0, 10.1})
        for (Index k = 0; k < sides; ++k) {
            const double angle = 2 * pi * k / sides;
            mesh.positions.push_back({std::cos(angle), std::sin(angle), z});
        }
    for (Index ring = 0; ring < 3; ++ring)
        for (Index k = 0; k < sides; ++k) {
            const Index a = ring * sides + k, b = ring * sides + (k + 1) % sides;
            mesh.faces.push_back({a, b, b + sides}), mesh.faces.push_back({a, b + sides, a + sides});
        }
    return mesh;
}

TEST(CalibratedBands, AreTheDefaultWhereEdgesDifferMuch) {
    for (const auto& [name, mesh] : every_class())
        EXPECT_GE(edge_spread(mesh.faces, mesh.positions), 1 - 1e-12) << name;
    const Mesh scan = shapes::scan(3000), tessellated = bar();
    EXPECT_EQ(default_method(scan), BandMethod::pyramid);
    EXPECT_EQ(default_method(shapes::irregular_sphere(3000, {0.3, 0.3, 4})), BandMethod::pyramid);
    EXPECT_EQ(default_method(tessellated), BandMethod::spline);
    Mesh large = tessellated;
    for (Vec3& p : large.positions) p = 1e6 * p + Vec3(1, 2, 3);
    EXPECT_NEAR(edge_spread(large.faces, large.positions), edge_spread(bar().faces, bar().positions), 1e-9);
}

TEST(CalibratedBands, MeasuredTransmissionIsReported) {
    const Layer layer = layer_of(shapes::irregular_sphere(6000, {0.3, 0.3, 4}));
    auto o = calibrated(LowPassOptions());
    o.cutoff = 8 * edge(layer);
    o.calibration.measure = true;
    Session session;
    const Result result = low_pass(layer, o, session);
    int found = 0;
    for (const Report::Entry& e : result.report.entries())
        if (e.key == "measured_transmission") {
            const auto& values = std::get<std::vector<double>>(e.value);
            ASSERT_EQ(values.size(), 3U);
            EXPECT_NEAR(values[1], 0.5, 0.03);
            ++found;
        }
    EXPECT_EQ(found, 1);
    EXPECT_EQ(result.report.lines().size(), 3U);
}

}  // namespace multires
