#include "schemes/sure.h"

#include "denoise_fixtures.h"

namespace multires {

using namespace fixtures;

namespace {

struct Sample {
    std::vector<double> truth, noisy;  // #details by width
    int width;

    double error(double threshold, Shrink rule) const {
        double sum = 0;
        std::vector<double> d = noisy;
        for (std::size_t i = 0; i < d.size(); i += width) {
            shrink(d.data() + i, width, threshold, rule);
            for (int c = 0; c < width; ++c) sum += std::pow(d[i + c] - truth[i + c], 2);
        }
        return sum;
    }
    std::vector<double> lengths() const {
        std::vector<double> out;
        for (std::size_t i = 0; i < noisy.size(); i += width) {
            double square = 0;
            for (int c = 0; c < width; ++c) square += noisy[i + c] * noisy[i + c];
            out.push_back(std::sqrt(square));
        }
        return out;
    }
};

/// A share of the details is large, the others are next to nothing.
Sample sample(int width, double share, double size, double deviation, std::uint64_t seed) {
    shapes::Random random(seed);
    Sample s{{}, {}, width};
    for (int i = 0; i < 4000; ++i) {
        const double here = random.chance(share) ? size : 0.01 * size;
        for (int c = 0; c < width; ++c) {
            s.truth.push_back(here * gaussian(random));
            s.noisy.push_back(s.truth.back() + deviation * gaussian(random));
        }
    }
    return s;
}

}  // namespace

TEST(Sure, IsNearTheBestThresholdThereIs) {
    for (const Shrink rule : {Shrink::soft, Shrink::hard})
        for (const int width : {1, 2, 3})
            for (const double share : {0.05, 0.3, 0.9})
                for (const double size : {1.0, 5.0}) {
                    const double deviation = 0.7;
                    const Sample s = sample(width, share, size, deviation, 1 + width);
                    double best = 1e300;
                    for (double t = 0; t < 6; t += 0.05) best = std::min(best, s.error(t, rule));
                    const double t = sure_threshold(s.lengths(), width, deviation, rule);
                    // Two deviations of what the estimate scatters by.
                    const double scatter = 2 * deviation * deviation * std::sqrt(2.0 * s.noisy.size());
                    EXPECT_LE(s.error(t, rule), best + scatter) << width << " " << share << " " << size;
                }
}

TEST(Sure, RemovesPureNoiseAndLeavesShape) {
    for (const Shrink rule : {Shrink::soft, Shrink::hard})
        for (const int width : {1, 3}) {
            const Sample noise = sample(width, 1, 0, 2, 5);
            const double t = sure_threshold(noise.lengths(), width, 2, rule);
            EXPECT_LT(noise.error(t, rule), 0.01 * noise.error(0, rule));
            const Sample shape = sample(width, 1, 1, 0.001, 5);
            EXPECT_LT(sure_threshold(shape.lengths(), width, 0.001, rule), 0.01);
        }
}

TEST(Sure, HasTheUnitOfItsDetails) {
    const Sample s = sample(1, 0.3, 2, 0.5, 9);
    std::vector<double> lengths = s.lengths();
    for (const Shrink rule : {Shrink::soft, Shrink::hard}) {
        const double t = sure_threshold(lengths, 1, 0.5, rule);
        std::vector<double> scaled = lengths;
        for (double& l : scaled) l *= 1e6;
        EXPECT_NEAR(sure_threshold(scaled, 1, 0.5e6, rule), 1e6 * t, 1e-3);
        std::reverse(scaled.begin(), scaled.end());
        EXPECT_NEAR(sure_threshold(scaled, 1, 0.5e6, rule), 1e6 * t, 1e-3);
        EXPECT_EQ(sure_threshold(lengths, 1, 0, rule), 0);
        EXPECT_EQ(sure_threshold({}, 1, 1, rule), 0);
    }
}

}  // namespace multires
