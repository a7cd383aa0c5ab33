#include "filters/attributes/attributes_band.h"

#include "fixtures.h"
#include "measure/measure.h"
#include "scheme_fixtures.h"

#include <cmath>
#include <limits>

namespace multires {

using namespace fixtures;

namespace {

Layer with(Mesh mesh, std::vector<Attribute> attributes) {
    Layer layer;
    layer.mesh = std::move(mesh);
    layer.attributes = std::move(attributes);
    return layer;
}

Attribute quality(std::vector<double> values) { return {AttributeKind::quality, "", 1, std::move(values)}; }

Result filter(const Layer& layer, const AttributeBandOptions& options, Session&& session = {}) {
    return filter_attribute_bands(layer, options, session);
}

/// How much of two components is left in a function, by least squares (they are nearly orthogonal).
std::pair<double, double> left(const std::vector<double>& f, const std::vector<double>& a,
                               const std::vector<double>& b) {
    double aa = 0, ab = 0, bb = 0, fa = 0, fb = 0;
    for (std::size_t i = 0; i < f.size(); ++i) {
        aa += a[i] * a[i], ab += a[i] * b[i], bb += b[i] * b[i];
        fa += f[i] * a[i], fb += f[i] * b[i];
    }
    const double det = aa * bb - ab * ab;
    return {(fa * bb - fb * ab) / det, (fb * aa - fa * ab) / det};
}

/// A quality of two spherical harmonics on a smooth sphere.
struct TwoBands {
    shapes::BandedSphere sphere;
    Layer layer;
    double between;  // wavelength between the two

    TwoBands() {
        shapes::BandedSphereOptions o;
        o.vertices = 10000;
        o.low_amplitude = o.high_amplitude = 0.5;
        sphere = shapes::banded_sphere(o);
        std::vector<double> q(sphere.low.size());
        for (std::size_t i = 0; i < q.size(); ++i) q[i] = 3 + sphere.low[i] + sphere.high[i];
        sphere.mesh.positions = sphere.sphere;
        layer = with(sphere.mesh, {quality(q)});
        const auto wave = [](double degree) { return 2 * std::acos(-1.0) / std::sqrt(degree * (degree + 1)); };
        between = std::sqrt(wave(o.low_degree) * wave(o.high_degree));
    }
    std::pair<double, double> left_in(const Result& result) const {
        std::vector<double> f = result.attributes.at(0).values;
        for (double& x : f) x -= 3;
        return left(f, sphere.low, sphere.high);
    }
};

const TwoBands& two_bands() {
    static const TwoBands made;
    return made;
}

AttributeBandOptions of_quality(BandMode mode) {
    AttributeBandOptions options;
    options.what.quality = true;
    options.mode = mode;
    options.cutoff = two_bands().between;
    options.band.finest = 0;
    options.band.coarsest = two_bands().between;
    return options;
}

TEST(AttributeBands, LowPassLeavesTheCoarseBand) {
    const auto [low, high] = two_bands().left_in(filter(two_bands().layer, of_quality(BandMode::low_pass)));
    EXPECT_NEAR(low, 1, 0.07);  // found: 0.94, the fine details take the rest
    EXPECT_NEAR(high, 0, 0.05);
}

TEST(AttributeBands, StopBandOfTheCoarseBandLeavesTheFineOne) {
    AttributeBandOptions options = of_quality(BandMode::stop_band);
    options.band.finest = two_bands().between;
    options.band.coarsest = 100;
    options.pyramid.hierarchy.base_vertices = 4;
    const auto [low, high] = two_bands().left_in(filter(two_bands().layer, options));
    EXPECT_LT(std::abs(low), 0.07);  // found: 0.06, what low pass takes from it
    EXPECT_NEAR(high, 1, 0.05);
}

TEST(AttributeBands, EnhanceByThreeAddsTwiceWhatLowPassTakes) {
    AttributeBandOptions options = of_quality(BandMode::enhance);
    options.gain = 3;
    const auto [low, high] = two_bands().left_in(filter(two_bands().layer, options));
    const auto passed = two_bands().left_in(filter(two_bands().layer, of_quality(BandMode::low_pass)));
    const auto [low_passed, high_passed] = passed;
    EXPECT_NEAR(low, 1 + 2 * (1 - low_passed), 1e-9);
    EXPECT_NEAR(high, 1 + 2 * (1 - high_passed), 1e-9);
}

TEST(AttributeBands, LowPassAndTheRestAddUp) {
    // Plain channels: every scheme is linear in them, so gains add.
    AttributeBandOptions options = of_quality(BandMode::enhance);
    for (const int scheme : fixtures::every_scheme()) {
        options.pyramid.scheme.row = scheme;
        const Layer& layer = two_bands().layer;
        std::vector<double> at[3];
        for (int g = 0; g < 3; ++g) {
            options.gain = g;
            at[g] = filter(layer, options).attributes[0].values;
        }
        for (std::size_t i = 0; i < at[0].size(); ++i) {
            EXPECT_NEAR(at[1][i], layer.attributes[0].values[i], 1e-10);
            EXPECT_NEAR(at[2][i] - at[1][i], at[1][i] - at[0][i], 1e-9);
        }
    }
}

TEST(AttributeBands, ChannelsOfAColourAreFilteredEachByItself) {
    Layer layer = two_bands().layer;
    const std::vector<double>& q = layer.attributes[0].values;
    Attribute color{AttributeKind::color, "", 4, {}}, point{AttributeKind::point, "flow", 3, {}};
    for (const double x : q) {
        for (int k = 0; k < 4; ++k) color.values.push_back(40 * x);
        for (int k = 0; k < 3; ++k) point.values.push_back(40 * x);
    }
    layer.attributes.push_back(color);
    layer.attributes.push_back(point);
    AttributeBandOptions options = of_quality(BandMode::low_pass);
    options.what.color = options.what.custom = true;
    const Result result = filter(layer, options);
    ASSERT_EQ(result.attributes.size(), 3u);
    for (const Attribute& a : result.attributes) {
        const Attribute& of_quality = result.attributes[1];
        ASSERT_EQ(of_quality.kind, AttributeKind::quality);
        if (a.kind == AttributeKind::quality) continue;
        for (std::size_t i = 0; i < a.values.size(); ++i)  // no frame turned them
            EXPECT_NEAR(a.values[i], 40 * of_quality.values[i / a.width], 1e-9);
    }
}

TEST(AttributeBands, ConstantsStayExactly) {
    for (const auto& [name, mesh] : every_class()) {
        const Layer layer =
            with(mesh, {quality(std::vector<double>(mesh.positions.size(), 0.1)),
                        {AttributeKind::color, "", 4, std::vector<double>(4 * mesh.positions.size(), 77)}});
        for (const BandMode mode : {BandMode::low_pass, BandMode::enhance}) {
            AttributeBandOptions options;
            options.what.quality = options.what.color = true;
            options.linear_light = true;
            options.mode = mode;
            options.band.unit = Unit::level;
            options.band.coarsest = options.cutoff = 3;
            const Result result = filter(layer, options);
            EXPECT_EQ(result.attributes[0].values, layer.attributes[1].values) << name;
            EXPECT_EQ(result.attributes[1].values, layer.attributes[0].values) << name;
            EXPECT_FALSE(result.positions) << name;
        }
    }
}

TEST(AttributeBands, HonoursTheSelection) {
    Layer layer = two_bands().layer;
    layer.selected_vertex.resize(layer.mesh.positions.size());
    for (std::size_t i = 0; i < layer.selected_vertex.size(); ++i)
        layer.selected_vertex[i] = layer.mesh.positions[i].x() > 0;
    AttributeBandOptions options = of_quality(BandMode::low_pass);
    const std::vector<double> full = filter(layer, options).attributes[0].values;
    options.region.selected = true;
    const std::vector<double> some = filter(layer, options).attributes[0].values;
    for (std::size_t i = 0; i < some.size(); ++i)
        EXPECT_EQ(some[i], layer.selected_vertex[i] ? full[i] : layer.attributes[0].values[i]);
}

TEST(AttributeBands, ReusesTheKeptPyramid) {
    const Layer& layer = two_bands().layer;
    Session session;
    filter_attribute_bands(layer, of_quality(BandMode::low_pass), session);
    const auto kept = session.pyramids.all();
    ASSERT_EQ(kept.size(), 1u);
    filter_attribute_bands(layer, of_quality(BandMode::stop_band), session);
    EXPECT_EQ(session.pyramids.all(), kept);
}

TEST(AttributeBands, RefusesWhatMakesNoSense) {
    Layer layer = two_bands().layer;
    const auto refused = [&](auto change) {
        AttributeBandOptions options = of_quality(BandMode::low_pass);
        change(options);
        EXPECT_THROW(filter(layer, options), InputError);
    };
    refused([](AttributeBandOptions& o) { o.cutoff = 0; });
    refused([](AttributeBandOptions& o) { o.cutoff = NAN; });
    refused([](AttributeBandOptions& o) { o.mode = BandMode::enhance, o.gain = INFINITY; });
    refused([](AttributeBandOptions& o) { o.mode = BandMode::stop_band, o.band.finest = 2; });
    refused([](AttributeBandOptions& o) { o.what.color = true; });
    refused([](AttributeBandOptions& o) { o.what = {}; });
    layer.attributes[0].values[3] = NAN;
    refused([](AttributeBandOptions&) {});
}

// ---- the scheme's part
// --------------------------------------------------------------------------------------------

TEST(Subdivision, IsSynthesisWithoutDetails) {
    const Layer& layer = two_bands().layer;
    for (const int scheme : fixtures::every_scheme()) {
        PyramidOptions options;
        options.scheme.row = scheme;
        const Pyramid pyramid(layer, options, Progress());
        for (const bool positions : {true, false}) {
            Field f = field_of(layer.mesh.positions);
            f.has_positions = positions;
            const Coefficients c = pyramid.scheme().analyse(to_places(pyramid.hierarchy(), f));
            EXPECT_EQ(c.base.has_positions, positions);
            const std::size_t levels = pyramid.hierarchy().levels.size();
            const Field none = pyramid.scheme().synthesise(c, with_gain(std::vector<double>(levels, 0)));
            const Field smooth = pyramid.scheme().synthesise({}, starting_at(levels, c.base));
            ASSERT_EQ(smooth.values.size(), none.values.size());
            for (std::size_t i = 0; i < none.values.size(); ++i) EXPECT_NEAR(smooth.values[i], none.values[i], 1e-12);
            EXPECT_EQ(pyramid.scheme().synthesise({}, starting_at(0, f)).values, f.values);
        }
    }
}

TEST(Subdivision, PlainChannelsHaveNoFrames) {
    // Three equal channels keep equal details only if nothing turns them.
    const Layer& layer = two_bands().layer;
    const Pyramid pyramid(layer, {}, Progress());
    Field f(static_cast<Index>(layer.mesh.positions.size()), 3);
    for (Index r = 0; r < f.rows(); ++r) std::fill_n(f.row(r), 3, layer.attributes[0].values[r]);
    f.has_positions = false;
    const Coefficients c = pyramid.scheme().analyse(to_places(pyramid.hierarchy(), f));
    for (const std::vector<Subband>& level : c.level)
        for (const Subband& band : level)
            for (Index r = 0; r < band.rows(); ++r) EXPECT_EQ(band.values.row(r)[0], band.values.row(r)[2]);
}

}  // namespace
}  // namespace multires
