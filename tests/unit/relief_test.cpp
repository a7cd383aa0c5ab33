#include "filters/analysis/relief.h"

#include "filter_fixtures.h"
#include "fixtures.h"
#include "measure/measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

namespace multires {

using namespace fixtures;

namespace {

Result relief_of(const Layer& layer, const ReliefOptions& options = {}) {
    Session session;
    return relief(layer, options, session);
}

/// Area under the ROC curve: the chance that a vertex of a letter lies lower than one beside the letters.
double auc(const std::vector<double>& height, const std::vector<double>& cut) {
    std::vector<std::size_t> order(height.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return height[a] < height[b]; });
    double letters = 0, before = 0, others = 0;
    for (const std::size_t i : order) {
        if (cut[i] > 0.03)
            ++letters;
        else
            ++others, before += letters;
    }
    return before / (letters * others);
}

shapes::EngravedStone small_stone(std::uint64_t seed) {
    shapes::EngravedStoneOptions o;
    o.spacing = 0.6;
    o.seed = seed;
    return shapes::engraved_stone(o);
}

}  // namespace

TEST(Relief, OfAWaveIsTheWaveInMeshUnits) {
    const auto sphere = shapes::banded_sphere({10000, 4, 40, 0.0, 0.002, {0.3, 0, 1}});
    ReliefOptions o;
    o.coarsest = 4 * 2 * 3.14159 / 40.5;
    o.robust = false;
    const Result r = relief_of(layer_of(sphere.mesh), o);
    std::vector<double> error(sphere.high.size());
    for (std::size_t i = 0; i < error.size(); ++i) error[i] = (*r.quality)[i] - sphere.high[i];
    const double level = std::accumulate(error.begin(), error.end(), 0.0) / static_cast<double>(error.size());
    for (double& e : error) e -= level;  // that of the sphere, which is a long wave itself
    EXPECT_LT(rms(error), 0.05 * rms(sphere.high));
    EXPECT_EQ(number(r.report, "finest"), 0);
    EXPECT_EQ(number(r.report, "coarsest"), *o.coarsest);
}

TEST(Relief, TheBandIsThatOfTheLetters) {
    for (const std::uint64_t seed : {21, 22, 23}) {
        const auto stone = small_stone(seed);
        const Result r = relief_of(layer_of(stone.mesh));
        EXPECT_GT(auc(*r.quality, stone.cut), 0.85) << seed;
        EXPECT_GT(number(r.report, "coarsest"), 6) << seed;
        EXPECT_LT(number(r.report, "coarsest"), 18) << seed;
        EXPECT_LT(number(r.report, "skewness"), -0.2) << seed;
    }
}

TEST(Relief, RobustLowPassesShowTheDepthOfLetters) {
    for (const std::uint64_t seed : {27, 28}) {
        const auto stone = small_stone(seed);
        ReliefOptions o;
        o.coarsest = 8;
        const auto depth = [&](bool robust) {
            o.robust = robust;
            const Result r = relief_of(layer_of(stone.mesh), o);
            double deep = 0, count = 0;
            for (std::size_t i = 0; i < stone.cut.size(); ++i)
                if (stone.cut[i] > 0.25) deep -= (*r.quality)[i], ++count;
            return std::pair(deep / count, auc(*r.quality, stone.cut));
        };
        const auto [robust, told] = depth(true);
        const auto [linear, told_linear] = depth(false);
        EXPECT_GT(robust, 0.79 * 0.275) << seed;
        EXPECT_GT(robust, 1.2 * linear) << seed;
        EXPECT_GT(told, told_linear + 0.01) << seed;
    }
}

TEST(Relief, TheBandGrowsWithTheMesh) {
    auto stone = small_stone(24);
    const Result here = relief_of(layer_of(stone.mesh));
    for (Vec3& p : stone.mesh.positions) p *= 1000;
    const Result there = relief_of(layer_of(stone.mesh));
    EXPECT_NEAR(number(there.report, "coarsest"), 1000 * number(here.report, "coarsest"), 1e-3);
    EXPECT_NEAR(number(there.report, "skewness"), number(here.report, "skewness"), 1e-5);
}

TEST(Relief, FacesTurnedOverTurnTheHeights) {
    auto stone = small_stone(25);
    const Result up = relief_of(layer_of(stone.mesh));
    for (Face& f : stone.mesh.faces) std::swap(f[0], f[1]);
    const Result down = relief_of(layer_of(stone.mesh));
    std::vector<double> sum(up.quality->size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = (*up.quality)[i] + (*down.quality)[i];
    EXPECT_LT(rms(sum), 1e-5 * rms(*up.quality));
}

TEST(Relief, ColoursAreCentredOnZero) {
    ReliefOptions o;
    o.color = true;
    const Result r = relief_of(layer_of(small_stone(26).mesh), o);
    ASSERT_EQ(r.attributes.size(), 1u);
    const std::vector<double>& c = r.attributes[0].values;
    for (std::size_t i = 0; i < r.quality->size(); ++i) {
        const double h = (*r.quality)[i], red = c[4 * i], blue = c[4 * i + 2];
        EXPECT_GE(h * (red - blue), 0) << h;
        EXPECT_EQ(c[4 * i + 3], 255);
    }
}

TEST(Relief, RefusesWhatIsNoBand) {
    const Layer layer = layer_of(shapes::irregular_sphere(1000));
    const double e = mean_edge_length(layer.mesh.faces, layer.mesh.positions);
    const auto says = [&](std::optional<double> coarsest, double finest, const char* what) {
        ReliefOptions o;
        o.coarsest = coarsest, o.finest = finest;
        try {
            relief_of(layer, o);
            ADD_FAILURE() << what;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
        }
    };
    says(e, 0, "coarsest must be at least two mean edges");
    says(8 * e, e, "finest must be at least two mean edges");
    says(8 * e, 8 * e, "coarsest must be more than finest");
    says(std::nan(""), 0, "coarsest must be more than finest");
    says(8 * e, std::nan(""), "finest must be a number");
    says(std::nullopt, 1000, "finest must be less");
}

}  // namespace multires
