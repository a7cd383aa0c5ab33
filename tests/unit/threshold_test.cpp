#include "schemes/threshold.h"

#include "denoise_fixtures.h"
#include "scheme_fixtures.h"

namespace multires {

using namespace fixtures;

namespace {

std::vector<double> shrunk(std::vector<double> d, double t, Shrink rule) {
    shrink(d.data(), static_cast<int>(d.size()), t, rule);
    return d;
}

}  // namespace

TEST(Threshold, SoftRuleShortensVectorsByTheThreshold) {
    shapes::Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 d = random.direction() * random.uniform(0, 3);
        const double t = random.uniform(0, 2);
        Vec3 s = d;
        const bool zeroed = shrink(s.data(), 3, t, Shrink::soft);
        EXPECT_EQ(zeroed, d.norm() <= t);
        EXPECT_EQ(zeroed, s == Vec3::Zero());
        EXPECT_NEAR(s.norm(), std::max(0.0, d.norm() - t), 1e-15);
        EXPECT_LE(s.cross(d).norm(), 1e-15);  // the direction stays
        EXPECT_GE(s.dot(d), 0);
    }
}

TEST(Threshold, HardRuleKeepsOrDrops) {
    EXPECT_EQ(shrunk({3, 0, 4}, 4.999, Shrink::hard), (std::vector<double>{3, 0, 4}));
    EXPECT_EQ(shrunk({3, 0, 4}, 5, Shrink::hard), (std::vector<double>{0, 0, 0}));
    EXPECT_EQ(shrunk({-2}, 1, Shrink::hard), (std::vector<double>{-2}));
    EXPECT_EQ(shrunk({-2}, 3, Shrink::hard), (std::vector<double>{0}));
}

TEST(Threshold, ZeroLeavesEverything) {
    for (const Shrink rule : {Shrink::soft, Shrink::hard}) {
        EXPECT_EQ(shrunk({1e-300, -2, 7}, 0, rule), (std::vector<double>{1e-300, -2, 7}));
        EXPECT_EQ(shrunk({0, 0}, 0, rule), (std::vector<double>{0, 0}));
    }
}

TEST(Threshold, DeviationByMedianIsThatOfGaussianNoiseAndRobust) {
    shapes::Random random(5);
    std::vector<double> values(20001);
    for (double& v : values) v = 0.3 * gaussian(random);
    EXPECT_NEAR(deviation_by_median(values), 0.3, 0.01);
    for (std::size_t i = 0; i < values.size(); i += 50) values[i] = 1e9;
    EXPECT_NEAR(deviation_by_median(values), 0.3, 0.02);
    std::vector<double> none;
    EXPECT_EQ(deviation_by_median(none), 0);
}

TEST(NoiseGains, AreWhatNoiseMeasures) {
    for (const int scheme : fixtures::all_schemes()) {
        const Layer layer = layer_of(fixtures::suited(scheme, shapes::scan(4000)));
        PyramidOptions options;
        options.scheme.row = scheme;
        const Pyramid pyramid(layer, options, Progress());
        const NoiseGains gains = noise_gains(pyramid.hierarchy(), pyramid.scheme());
        ASSERT_EQ(gains.size(), pyramid.coefficients().level.size());
        shapes::Random random(11);
        Field noise(pyramid.hierarchy().vertices(), 8);
        noise.has_positions = false;
        for (double& v : noise.values) v = gaussian(random);
        const Coefficients c = pyramid.scheme().analyse(noise);
        for (std::size_t k = 0; k < gains.size(); ++k) {
            SCOPED_TRACE(k);
            ASSERT_EQ(gains[k].size(), c.level[k].size());
            for (std::size_t b = 0; b < gains[k].size(); ++b) {
                const Array<double>& values = c.level[k][b].values.values;
                if (c.level[k][b].rows() < 200) continue;  // too few for a measurement
                // The gains come from one channel of so many numbers, whose RMS scatters by 1 / sqrt(2 rows); of those
                // of a level no more are independent than vertices go.
                Index all = 0;
                for (const Subband& band : c.level[k]) all += band.rows();
                const double share = std::min(1.0, 1.0 * pyramid.hierarchy().levels[k].odd.size() / all);
                EXPECT_NEAR(gains[k][b] / rms({values.begin(), values.end()}), 1,
                            3 / std::sqrt(2 * share * c.level[k][b].rows()));
            }
        }
    }
}

}  // namespace multires
