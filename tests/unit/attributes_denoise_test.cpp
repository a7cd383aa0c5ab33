#include "filters/attributes/attributes_denoise.h"

#include "measure/measure.h"

#include "fixtures.h"
#include "reported.h"
#include "scheme_fixtures.h"

#include <cmath>
#include <limits>

namespace multires {

using namespace fixtures;

namespace {

/// A standard normal number.
double normal(shapes::Random& random) {
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += random.uniform(0, 1);
    return sum;
}

std::vector<double> noisy(std::vector<double> values, double deviation, std::uint64_t seed) {
    shapes::Random random(seed);
    for (double& x : values) x += deviation * normal(random);
    return values;
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

/// A smooth function with a jump, on a sphere: what denoising must keep.
struct Scene {
    Layer layer;
    std::vector<double> quality, color;  // without noise

    Scene() {
        layer.mesh = shapes::irregular_sphere(6000);
        const std::vector<double> smooth = shapes::harmonic(layer.mesh.positions, 6, 1);
        for (std::size_t i = 0; i < smooth.size(); ++i) {
            const double jump = layer.mesh.positions[i].x() > 0.2 ? 1 : 0;
            quality.push_back(smooth[i] + 3 * jump);
            for (const double x : {100 + 20 * smooth[i], 60 + 100 * jump, 150 - 20 * smooth[i], 255.0})
                color.push_back(std::clamp(x, 0.0, 255.0));
        }
    }
    Layer with_noise(double of_quality, double of_color) const {
        Layer out = layer;
        out.attributes = {{AttributeKind::quality, "", 1, noisy(quality, of_quality, 1)},
                          {AttributeKind::color, "", 4, noisy(color, of_color, 2)}};
        for (std::size_t i = 0; i < color.size(); ++i) {
            double& x = out.attributes[1].values[i];
            x = i % 4 == 3 ? 255 : std::clamp(std::round(x), 0.0, 255.0);
        }
        return out;
    }
};

const Scene& scene() {
    static const Scene made;
    return made;
}

Result denoise(const Layer& layer, const AttributeDenoiseOptions& options) {
    Session session;
    return denoise_attributes(layer, options, session);
}

AttributeDenoiseOptions of_quality(AttributeRule rule = AttributeRule::automatic) {
    AttributeDenoiseOptions options;
    options.what.quality = true;
    options.rule = rule;
    return options;
}

Layer with_quality(const Mesh& mesh, std::vector<double> values) {
    Layer layer;
    layer.mesh = mesh;
    layer.attributes = {{AttributeKind::quality, "", 1, std::move(values)}};
    return layer;
}

TEST(DenoiseAttributes, FindsTheNoiseWhateverTheSchemeAndOperator) {
    for (const double deviation : {0.05, 0.2, 0.5})
        for (const int scheme : fixtures::every_scheme())
            for (const Operator op : {Operator::cotangent_delaunay, Operator::second_difference_flaps}) {
                AttributeDenoiseOptions options = of_quality(AttributeRule::soft);
                options.pyramid.scheme.row = scheme;
                options.pyramid.scheme.op = op;
                const Result result = denoise(scene().with_noise(deviation, 0), options);
                const double found = reported<double>(result, "quality_noise");
                EXPECT_NEAR(found, deviation, 0.1 * deviation);  // a quantile of 6000: three deviations
            }
}

TEST(DenoiseAttributes, TakesMostOfTheNoiseAway) {
    for (const double deviation : {0.05, 0.2, 0.5}) {
        const Layer layer = scene().with_noise(deviation, 0);
        const auto left = [&](AttributeRule rule) {
            return rms_difference(denoise(layer, of_quality(rule)).attributes[0].values, scene().quality) / deviation;
        };
        EXPECT_LT(left(AttributeRule::soft), deviation > 0.1 ? 0.65 : 0.9);
        EXPECT_LT(left(AttributeRule::hard), deviation > 0.1 ? 0.7 : 0.9);
        EXPECT_LT(left(AttributeRule::automatic), deviation > 0.3 ? 0.42 : deviation > 0.1 ? 0.53 : 0.8);
    }
}

// The blend is chosen on patches, few of which see the jump; others see nothing but noise.
TEST(DenoiseAttributes, TakesAsMuchFromLargeMeshes) {
    const auto left = [](Index frequency) {
        const Mesh mesh = shapes::icosphere(frequency);
        std::vector<double> truth;
        for (const Vec3& p : mesh.positions)
            truth.push_back((p.x() > 0.2 ? 3 : 0) + std::max(0.0, p.z()) * std::sin(0.2 * frequency * p.y()));
        const Layer layer = with_quality(mesh, noisy(truth, 0.2, 3));
        return rms_difference(denoise(layer, of_quality()).attributes[0].values, truth) / 0.2;
    };
    const double small = left(60), large = left(86);  // 36,002 vertices, 73,962
    EXPECT_LT(small, 0.4);
    EXPECT_NEAR(large, small, 0.05 * small);
}

TEST(DenoiseAttributes, EstimatesItsError) {
    const Mesh& mesh = scene().layer.mesh;
    const std::vector<double> smooth = shapes::harmonic(mesh.positions, 2, 1);
    for (const double deviation : {0.1, 0.4}) {
        const Result result = denoise(with_quality(mesh, noisy(smooth, deviation, 3)), of_quality());
        EXPECT_NEAR(reported<double>(result, "quality_noise"), deviation, 0.05 * deviation);
        EXPECT_NEAR(reported<double>(result, "quality_estimated_rms_before"), deviation, 0.05 * deviation);
        const double after = rms_difference(result.attributes[0].values, smooth);
        EXPECT_LT(after, 0.35 * deviation);
        EXPECT_NEAR(reported<double>(result, "quality_estimated_rms_after"), after, 0.12 * deviation);
    }
}

TEST(DenoiseAttributes, FollowsNoiseThatVaries) {
    const Mesh mesh = shapes::irregular_sphere(15000);
    const std::vector<double> smooth = shapes::harmonic(mesh.positions, 2, 1);
    std::vector<double> values = smooth;
    shapes::Random random(5);
    double squares = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double noise = (0.2 + 0.18 * mesh.positions[i].z()) * normal(random);  // 0.02 to 0.38
        values[i] += noise;
        squares += noise * noise / static_cast<double>(values.size());
    }
    const Result result = denoise(with_quality(mesh, values), of_quality());
    EXPECT_LT(rms_difference(result.attributes[0].values, smooth), 0.3 * std::sqrt(squares));
    EXPECT_LT(reported<double>(result, "quality_noise_least"), 0.1);
    EXPECT_LT(reported<double>(result, "quality_noise_least"), reported<double>(result, "quality_noise"));
    EXPECT_NEAR(reported<double>(result, "quality_noise_most"), 0.35, 0.08);
}

TEST(DenoiseAttributes, ReplacesImpulsesAndKeepsLinesAndSpots) {
    const Mesh& mesh = scene().layer.mesh;
    std::vector<double> truth = shapes::harmonic(mesh.positions, 6, 1);
    for (std::size_t i = 0; i < truth.size(); ++i)
        if (std::abs(mesh.positions[i].y()) < 0.02) truth[i] = 4;  // about one vertex wide
    truth[100] = -5;
    EXPECT_EQ(denoise(with_quality(mesh, truth), of_quality()).attributes[0].values[100], -5);
    std::vector<double> values = truth;
    shapes::Random random(9);
    for (double& x : values)
        if (random.uniform(0, 1) < 0.03) x = random.uniform(0, 1) < 0.5 ? -4 : 4;
    const Result result = denoise(with_quality(mesh, values), of_quality());
    EXPECT_NEAR(reported<int>(result, "quality_impulses"), 180, 45);
    EXPECT_LT(rms_difference(result.attributes[0].values, truth), 0.5 * rms_difference(values, truth));
}

TEST(DenoiseAttributes, SmoothsRoundedValuesWithinTheirSteps) {
    const Mesh& mesh = scene().layer.mesh;
    const std::vector<double> smooth = shapes::harmonic(mesh.positions, 2, 1);
    const auto [low, high] = std::minmax_element(smooth.begin(), smooth.end());
    const double step = (*high - *low) / 9;
    std::vector<double> values = smooth;
    for (double& x : values) x = step * std::round(x / step);
    const Result result = denoise(with_quality(mesh, values), of_quality());
    EXPECT_NEAR(reported<double>(result, "quality_rounding_step"), step, 1e-9 * step);
    const std::vector<double>& after = result.attributes[0].values;
    for (std::size_t i = 0; i < after.size(); ++i) EXPECT_LE(std::abs(after[i] - values[i]), step / 2 + 1e-12);
    EXPECT_LT(rms_difference(after, smooth), 0.7 * rms_difference(values, smooth));
    const double noise = reported<double>(result, "quality_noise");
    EXPECT_NEAR(noise, rms_difference(values, smooth), 0.1 * noise);
    for (const char* name :
         {"quality_noise_least", "quality_noise_most", "quality_estimated_rms_before", "quality_estimated_rms_after"})
        EXPECT_DOUBLE_EQ(reported<double>(result, name), noise) << name;
}

TEST(DenoiseAttributes, SameNoiseEverywhereHasNoRange) {
    const Result result = denoise(scene().with_noise(0.3, 0), of_quality());
    const double noise = reported<double>(result, "quality_noise");
    EXPECT_GT(noise, 0.25);
    EXPECT_NEAR(reported<double>(result, "quality_noise_least"), noise, 1e-9);
    EXPECT_NEAR(reported<double>(result, "quality_noise_most"), noise, 1e-9);
}

/// Signals between 0 and 1: smooth, textured with waves of a few edges, and with steps.
std::vector<std::pair<std::string, std::vector<double>>> signals(const Mesh& mesh) {
    const double edge = mean_edge_length(mesh.faces, mesh.positions);
    std::vector<double> smooth, textured, steps;
    for (const Vec3& p : mesh.positions) {
        const double slow = std::sin(2 * p.x()) * std::cos(3 * p.y()),
                     fast = std::sin(p.dot(Vec3(0.6, 0.5, 0.6)) / edge);
        smooth.push_back(0.5 + 0.5 * slow);
        textured.push_back(0.5 + 0.25 * slow + 0.25 * fast);
        steps.push_back(std::sin(5 * p.x()) * std::cos(4 * p.z()) > 0 ? 1 : 0);
    }
    return {{"smooth", smooth}, {"textured", textured}, {"steps", steps}};
}

// Texture and steps were taken for noise: a hundredth of noise became three of error.
TEST(DenoiseAttributes, NeverHarms) {
    for (const Mesh& mesh : {shapes::irregular_sphere(3000), shapes::scan(3000)})
        for (const auto& [name, truth] : signals(mesh))
            for (const double deviation : {0.0, 0.01, 0.03, 0.1, 0.3})
                for (const bool rounded : {false, true})
                    for (const AttributeRule rule :
                         {AttributeRule::soft, AttributeRule::hard, AttributeRule::automatic}) {
                        if (rounded == (rule == AttributeRule::soft)) continue;  // time
                        SCOPED_TRACE(name + " " + std::to_string(deviation) + (rounded ? " rounded" : ""));
                        AttributeDenoiseOptions options;
                        options.rule = rule;
                        (rounded ? options.what.color : options.what.quality) = true;
                        const std::vector<double> values = noisy(truth, deviation, 7);
                        Layer layer;
                        layer.mesh = mesh;
                        Attribute a{AttributeKind::quality, "", 1, values};
                        std::vector<double> wanted = truth;
                        if (rounded) {
                            a = {AttributeKind::color, "", 4, {}};
                            wanted.clear();
                            for (std::size_t i = 0; i < values.size(); ++i)
                                for (int c = 0; c < 4; ++c) {
                                    a.values.push_back(std::clamp(std::round(255 * values[i]), 0.0, 255.0));
                                    wanted.push_back(255 * truth[i]);
                                }
                        }
                        layer.attributes = {a};
                        const double before = rms_difference(a.values, wanted),
                                     after = rms_difference(denoise(layer, options).attributes[0].values, wanted);
                        EXPECT_LE(after, 1.01 * before + (rounded ? 0.3 : 0.001));
                    }
}

TEST(DenoiseAttributes, DenoisesColoursAsVectorsAndLeavesAlphaAlone) {
    const Layer layer = scene().with_noise(0, 15);
    AttributeDenoiseOptions options;
    options.what.color = true;
    for (const bool light : {true, false}) {
        options.linear_light = light;
        const Result result = denoise(layer, options);
        const std::vector<double>& after = result.attributes[0].values;
        const double before = rms_difference(layer.attributes[1].values, scene().color);
        EXPECT_LT(rms_difference(after, scene().color), (light ? 0.55 : 0.5) * before);
        for (std::size_t i = 3; i < after.size(); i += 4) EXPECT_EQ(after[i], 255);
    }
    EXPECT_NEAR(reported<double>(denoise(layer, options), "color_noise"), 15, 2);
}

TEST(DenoiseAttributes, LeavesWhatHasNoNoise) {
    for (const auto& [name, mesh] : every_class()) {
        Layer layer;
        layer.mesh = mesh;
        layer.attributes = {{AttributeKind::color, "", 4, std::vector<double>(4 * mesh.positions.size(), 77)},
                            {AttributeKind::quality, "", 1, std::vector<double>(mesh.positions.size(), 0.1)}};
        AttributeDenoiseOptions options = of_quality();
        options.what.color = true;
        const Result result = denoise(layer, options);
        for (int i = 0; i < 2; ++i) EXPECT_EQ(result.attributes[i].values, layer.attributes[i].values) << name;
        EXPECT_FALSE(result.positions);
    }
    const Result result = denoise(scene().with_noise(0, 0), of_quality());
    EXPECT_LT(rms_difference(result.attributes[0].values, scene().quality), 0.02);
}

TEST(DenoiseAttributes, StrengthZeroAndThresholdZeroChangeNothing) {
    const Layer layer = scene().with_noise(0.3, 0);
    AttributeDenoiseOptions options = of_quality();
    options.strength = 0;
    EXPECT_LT(rms_difference(denoise(layer, options).attributes[0].values, layer.attributes[0].values), 1e-12);
    options.automatic = false;
    EXPECT_LT(rms_difference(denoise(layer, options).attributes[0].values, layer.attributes[0].values), 1e-12);
    options.threshold = 1e9;
    const Result all = denoise(layer, options);
    for (const double share : reported<std::vector<double>>(all, "quality_zeroed")) EXPECT_EQ(share, 1);
}

TEST(DenoiseAttributes, LevelsAndGroupsAreAsChosen) {
    const Layer layer = scene().with_noise(0.3, 0);
    AttributeDenoiseOptions options = of_quality(AttributeRule::soft);
    options.coarsest_level = 4;
    EXPECT_EQ(reported<std::vector<double>>(denoise(layer, options), "quality_threshold").size(), 4u);
    options.finest_level = 2;
    EXPECT_EQ(reported<std::vector<double>>(denoise(layer, options), "quality_threshold").size(), 2u);
    options = of_quality(AttributeRule::soft);
    options.pyramid.hierarchy.grouping = Grouping::sequential;  // one vertex per level: still a handful of numbers
    const Result result = denoise(layer, options);
    EXPECT_LT(reported<std::vector<double>>(result, "quality_threshold").size(), 30u);
    EXPECT_NEAR(reported<double>(result, "quality_noise"), 0.3, 0.05);
    EXPECT_LT(rms_difference(result.attributes[0].values, scene().quality), 0.25);
}

TEST(DenoiseAttributes, HonoursTheSelection) {
    Layer layer = scene().with_noise(0.3, 0);
    layer.selected_vertex.assign(layer.mesh.positions.size(), 0);
    for (std::size_t i = 0; i < 1000; ++i) layer.selected_vertex[i] = 1;
    AttributeDenoiseOptions options = of_quality();
    options.region.selected = true;
    const std::vector<double> after = denoise(layer, options).attributes[0].values;
    for (std::size_t i = 1000; i < after.size(); ++i) EXPECT_EQ(after[i], layer.attributes[0].values[i]);
    EXPECT_NE(after[10], layer.attributes[0].values[10]);
}

TEST(DenoiseAttributes, DoesNotDependOnThreads) {
    const Layer layer = scene().with_noise(0.3, 10);
    AttributeDenoiseOptions options = of_quality();
    options.what.color = true;
    std::vector<std::vector<double>> values;
    for (const int count : {1, 3}) {
        const Threads threads(count);
        for (const Attribute& a : denoise(layer, options).attributes) values.push_back(a.values);
    }
    EXPECT_EQ(values[0], values[2]);
    EXPECT_EQ(values[1], values[3]);
}

TEST(DenoiseAttributes, RefusesWhatMakesNoSense) {
    Layer layer = scene().with_noise(0.3, 0);
    const auto refused = [&](auto change) {
        AttributeDenoiseOptions options = of_quality();
        change(options);
        EXPECT_THROW(denoise(layer, options), InputError);
    };
    refused([](AttributeDenoiseOptions& o) { o.strength = -1; });
    refused([](AttributeDenoiseOptions& o) { o.threshold = NAN; });
    refused([](AttributeDenoiseOptions& o) { o.finest_level = -1; });
    refused([](AttributeDenoiseOptions& o) { o.coarsest_level = 0; });
    refused([](AttributeDenoiseOptions& o) { o.what = {}; });
    refused([](AttributeDenoiseOptions& o) { o.what.custom = true; });
    layer.attributes[0].values[9] = INFINITY;
    refused([](AttributeDenoiseOptions&) {});
}

}  // namespace
}  // namespace multires
