#include "filter_fixtures.h"
#include "filters/analysis/read_watermark.h"
#include "filters/shape/watermark.h"
#include "measure/measure.h"
#include "random.h"
#include "watermark/code.h"
#include "watermark/reading.h"

#include <algorithm>
#include <cmath>
#include <numeric>

// Watermarks: the code, what embedding may change, reading after changes, refusals.

namespace multires {
namespace {

using fixtures::count;
using fixtures::layer_of;
using fixtures::number;
using fixtures::refusal;

const std::string message = "0123456789abcdef";

/// A bumpy sphere without symmetry.
Layer bumpy(Index vertices = 2500) {
    shapes::BandedSphereOptions o;
    o.vertices = vertices, o.low_degree = 3, o.low_amplitude = 0.1, o.high_degree = 9, o.high_amplitude = 0.01;
    return layer_of(shapes::banded_sphere(o).mesh);
}

WatermarkOptions marking(const std::string& key = "a key") {
    WatermarkOptions o;
    o.message = message, o.key = key;
    return o;
}

Layer marked(const Layer& layer, const WatermarkOptions& options = marking()) {
    Session session;
    return layer_of({*watermark(layer, options, session).positions, layer.mesh.faces});
}

Report reading(const Layer& layer, const Layer& original, const std::string& key = "a key",
               const std::string& expected = message) {
    ReadWatermarkOptions o;
    o.original.place = 0, o.key = key, o.expected = expected;
    Session session;
    return read_watermark({layer, {&original}}, o, session).report;
}

double diagonal(const Positions& positions) { return bounding_box(positions).diagonal(); }

/// Turned, scaled and shifted.
Layer moved(Layer layer) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Vec3(0.3, -0.8, 0.5).normalized()).toRotationMatrix();
    for (Vec3& p : layer.mesh.positions) p = 3.7 * turn * p + Vec3(5, -2, 9);
    return layer;
}

/// Vertices in another order.
Layer reordered(const Layer& layer) {
    const auto n = static_cast<Index>(layer.mesh.positions.size());
    std::vector<Index> place(n);
    std::iota(place.begin(), place.end(), 0);
    shapes::Random random(5);
    for (Index i = n - 1; i > 0; --i) std::swap(place[i], place[random.bits() % (i + 1)]);
    Layer out = layer;
    for (Index i = 0; i < n; ++i) out.mesh.positions[place[i]] = layer.mesh.positions[i];
    for (Face& f : out.mesh.faces)
        for (Index& v : f) v = place[v];
    std::reverse(out.mesh.faces.begin(), out.mesh.faces.end());
    return out;
}

}  // namespace

TEST(WatermarkCode, MessagesAreReadBackFromTheirCodeWordsWithTwelveBitsFlipped) {
    shapes::Random random(1);
    for (int round = 0; round < 50; ++round) {
        Message m;
        for (auto& bit : m) bit = random.bits() >> 63 & 1;
        const CodeWord word = encoded(m);
        CodeValues odds;
        for (int i = 0; i < code_bits; ++i) odds[i] = 3.0 * word[i] * (i % 12 == 5 ? -1 : 1);
        const auto result = decoded(odds);
        for (int i = 0; i < message_bits; ++i) ASSERT_EQ(result[i] < 0, m[i] == 1) << i;
    }
}

TEST(WatermarkCode, OddsOfBitsAreThoseOfAllCodeWordsAddedUp) {
    // Only the last three bits are open; the others are certain. Added up by brute force.
    Message m = message_of(message, "message");
    CodeValues odds;
    shapes::Random random(2);
    const CodeWord word = encoded(m);
    for (int i = 0; i < code_bits; ++i) odds[i] = i < 2 * (message_bits - 3) ? 60.0 * word[i] : random.uniform(-1, 1);
    const auto result = decoded(odds);
    for (int bit = message_bits - 3; bit < message_bits; ++bit) {
        double sum[2] = {0, 0};
        for (int all = 0; all < 8; ++all) {
            for (int k = 0; k < 3; ++k) m[message_bits - 3 + k] = all >> k & 1;
            const CodeWord w = encoded(m);
            double gain = 0;
            for (int i = 2 * (message_bits - 3); i < code_bits; ++i) gain += w[i] * odds[i] / 2;
            sum[m[bit]] += std::exp(gain);
        }
        EXPECT_NEAR(result[bit], std::log(sum[0] / sum[1]), 1e-9) << bit;
    }
}

TEST(WatermarkCode, BestCorrelationIsThatOfTheCodeWordItself) {
    const CodeWord word = encoded(message_of(message, "message"));
    CodeValues values;
    std::copy(word.begin(), word.end(), values.begin());
    EXPECT_EQ(best_correlation(values), code_bits);
    EXPECT_EQ(text_of(message_of("FEDCBA9876543210", "message")), "fedcba9876543210");
}

TEST(Watermark, MovesVerticesByItsStrengthAndFlipsNothing) {
    const Layer layer = bumpy();
    for (const double strength : {0.02, 0.08}) {
        WatermarkOptions o = marking();
        o.strength = strength;
        Session session;
        const Result result = watermark(layer, o, session);
        const double allowed = strength / 100 * diagonal(layer.mesh.positions);
        EXPECT_LE(number(result.report, "rms_displacement"), allowed * (1 + 1e-12));
        EXPECT_GE(number(result.report, "rms_displacement"), 0.9 * allowed);
        EXPECT_LE(number(result.report, "largest_displacement"), 4 * allowed);
        EXPECT_EQ(count(result.report, "flipped_faces"), 0);
    }
}

TEST(Watermark, IsReadBackWithAllBitsSure) {
    const Layer layer = bumpy();
    const Report report = reading(marked(layer), layer);
    EXPECT_EQ(count(report, "bit_errors"), 0);
    EXPECT_EQ(count(report, "sure_bits"), message_bits);
    EXPECT_LT(number(report, "probability_unmarked"), 1e-6);
    EXPECT_EQ(number(report, "carriers_seen"), 1);
}

TEST(Watermark, IsReadAfterMotionScaleReorderingAndNoise) {
    const Layer layer = bumpy();
    Layer now = moved(reordered(marked(layer)));
    shapes::Random random(3);
    const double noise = 0.0005 * diagonal(now.mesh.positions);
    for (Vec3& p : now.mesh.positions)
        p += noise * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Report report = reading(now, layer);
    EXPECT_EQ(count(report, "bit_errors"), 0);
    EXPECT_NEAR(number(report, "scale"), 1 / 3.7, 0.001);
    EXPECT_LT(number(report, "probability_unmarked"), 1e-4);
}

TEST(Watermark, IsReadFromAPart) {
    const Layer layer = bumpy(4000);
    Layer part = marked(layer);
    Faces& faces = part.mesh.faces;
    const auto beyond = [&](const Face& f) {
        return std::any_of(f.begin(), f.end(), [&](Index v) { return part.mesh.positions[v].x() > 0.4; });
    };
    faces.erase(std::remove_if(faces.begin(), faces.end(), beyond), faces.end());
    const Report report = reading(part, layer);
    EXPECT_EQ(count(report, "bit_errors"), 0);
    EXPECT_LT(number(report, "carriers_seen"), 0.9);
}

TEST(Watermark, OfAnotherKeyOrNoneIsNotSeen) {
    const Layer layer = bumpy(), mark = marked(layer);
    Layer noisy = layer;
    shapes::Random random(7);
    for (Vec3& p : noisy.mesh.positions) p *= 1 + 0.001 * random.uniform(-1, 1);
    for (const std::string key : {"wrong", "A key"}) {
        for (const Layer* now : {&mark, static_cast<const Layer*>(&noisy)}) {
            const Report report = reading(*now, layer, key);
            EXPECT_EQ(count(report, "sure_bits"), 0) << key;
            EXPECT_GT(number(report, "probability_unmarked"), 1e-3) << key;
            EXPECT_GT(count(report, "bit_errors"), 10) << key;
        }
    }
}

TEST(Watermark, OfAMeshThatIsItsOriginalIsNoneAtAll) {
    const Layer layer = bumpy(), same = layer;
    const Report report = reading(same, layer);
    EXPECT_EQ(count(report, "sure_bits"), 0);
    EXPECT_GT(number(report, "probability_unmarked"), 1e-3);
}

TEST(Watermark, StaysWithinTheSelection) {
    Layer layer = bumpy();
    layer.selected_vertex.assign(layer.mesh.positions.size(), 0);
    for (std::size_t i = 0; i < layer.mesh.positions.size(); ++i)
        layer.selected_vertex[i] = layer.mesh.positions[i].z() > 0;
    WatermarkOptions o = marking();
    o.region.selected = true;
    const Layer now = marked(layer, o);
    for (std::size_t i = 0; i < layer.mesh.positions.size(); ++i)
        EXPECT_EQ(now.mesh.positions[i] == layer.mesh.positions[i], layer.selected_vertex[i] == 0) << i;
}

TEST(Watermark, OfASmallMeshHasFewerCarriersAndSaysSo) {
    for (const int vertices : {400, 3}) {
        const Layer layer = layer_of(vertices == 3 ? shapes::fan(3, 1) : shapes::irregular_sphere(vertices, {}));
        Session session;
        const Report report = watermark(layer, marking(), session).report;
        EXPECT_EQ(count(report, "carriers"), (static_cast<int>(layer.mesh.positions.size()) + 1) / 2);
        const auto says = [](const std::string& line) { return line.find("may not be readable") < line.size(); };
        EXPECT_EQ(std::count_if(report.lines().begin(), report.lines().end(), says), 1);
        EXPECT_TRUE(std::isfinite(number(reading(marked(layer), layer), "probability_unmarked")));
    }
}

TEST(Watermark, RefusesWhatItCannotWriteOrReadAndNamesTheParameter) {
    const Layer layer = bumpy();
    for (const std::string bad : {"", "0123", "0123456789abcdeg", "0123456789abcdef0"}) {
        WatermarkOptions o = marking();
        o.message = bad;
        EXPECT_EQ(refusal([&] { marked(layer, o); }).find("message"), 0u) << bad;
    }
    EXPECT_EQ(refusal([&] { reading(layer, layer); }).find("original: "), 0u);
    EXPECT_EQ(refusal([&] { reading(layer, bumpy(2000), "", "xyz"); }).find("expected"), 0u);
    WatermarkOptions o = marking();
    for (const double strength : {0.0, -1.0, 1.5, std::nan("")}) {
        o.strength = strength;
        EXPECT_EQ(refusal([&] { marked(layer, o); }).find("strength"), 0u);
    }
}

TEST(Watermark, HasTheSameBitsForAnyNumberOfThreads) {
    const Layer layer = bumpy();
    std::vector<Positions> results;
    for (const int threads : {1, 3}) {
        const fixtures::Threads some(threads);
        results.push_back(marked(layer).mesh.positions);
    }
    EXPECT_EQ(results[0], results[1]);
}

}  // namespace multires
