#include "pyramid/band.h"

#include "filter_fixtures.h"

namespace multires {

using namespace fixtures;

namespace {

const Layer& layer() {
    static const Layer l = layer_of(shapes::scan(5000));
    return l;
}

const Pyramid& pyramid() {
    static const Pyramid p(layer(), fine_levels(), Progress());
    return p;
}

double diagonal() { return box_diagonal(layer()); }

std::vector<double> share(Unit unit, double finest, double coarsest, double softness = 0) {
    return band_share(pyramid(), {unit, finest, coarsest, softness}, diagonal());
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], tolerance) << "level " << k;
}

}  // namespace

TEST(Band, UnitsAgree) {
    const auto& levels = pyramid().levels();
    const auto at = [&](std::size_t k) { return levels[k].wavelength; };
    for (const double softness : {0.0, 0.7}) {
        const auto by_level = share(Unit::level, 2, 7, softness);
        expect_near(share(Unit::wavelength, at(2), at(7), softness), by_level, 1e-9);
        expect_near(share(Unit::wavelength_percent, 100 * at(2) / diagonal(), 100 * at(7) / diagonal(), softness),
                    by_level, 1e-9);
        expect_near(share(Unit::vertices, levels[2].vertices, levels[7].vertices, softness), by_level, 1e-9);
        // Between levels, halfway in the logarithm.
        const double between = std::sqrt(at(4) * at(5));
        const double vertices = std::sqrt(1.0 * levels[4].vertices * levels[5].vertices);
        expect_near(share(Unit::wavelength, at(1), between, softness), share(Unit::level, 1, 4.5, softness), 1e-9);
        expect_near(share(Unit::vertices, levels[1].vertices, vertices, softness), share(Unit::level, 1, 4.5, softness),
                    1e-9);
    }
}

TEST(Band, HardEdgesAtLevelsTakeWholeLevels) {
    const std::vector<double> s = share(Unit::level, 2, 7);
    for (std::size_t k = 0; k < s.size(); ++k) EXPECT_NEAR(s[k], k >= 2 && k < 7 ? 1 : 0, 1e-12);
    EXPECT_NEAR(share(Unit::level, 2.25, 7)[2], 0.75, 1e-12);
    EXPECT_NEAR(share(Unit::level, 2, 7.25)[7], 0.25, 1e-12);
}

TEST(Band, NeighbouringBandsShareTheirLevels) {
    for (const double softness : {0.0, 0.5, 2.0}) {
        const auto a = share(Unit::level, 1, 4.3, softness), b = share(Unit::level, 4.3, 9, softness);
        const auto both = share(Unit::level, 1, 9, softness);
        for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k] + b[k], both[k], 1e-9) << "level " << k;
    }
}

TEST(Band, LimitsBeyondTheEndsLeaveNothingOut) {
    const double last = static_cast<double>(pyramid().levels().size() - 1);
    const std::vector<double> all(pyramid().levels().size() - 1, 1);
    for (const double softness : {0.0, 1.0}) {
        expect_near(share(Unit::wavelength, 0, 1e30, softness), all, 0);
        expect_near(share(Unit::wavelength_percent, 0, 1e30, softness), all, 0);
        expect_near(share(Unit::vertices, 1e9, 0, softness), all, 0);
        expect_near(share(Unit::level, 0, last + 1, softness), all, 0);
        expect_near(share(Unit::level, 0, 1e9, softness), all, 0);
    }
}

TEST(Band, GrowsSteadilyWithItsLimits) {
    for (const double softness : {0.0, 0.8}) {
        std::vector<double> before = share(Unit::level, 2, 2.5, softness);
        for (double coarsest = 2.51; coarsest < 12; coarsest += 0.01) {
            const std::vector<double> now = share(Unit::level, 2, coarsest, softness);
            for (std::size_t k = 0; k < now.size(); ++k) {
                EXPECT_GE(now[k], before[k] - 1e-12);
                EXPECT_LE(now[k], before[k] + 0.011);  // a level is crossed in 100 steps
            }
            before = now;
        }
    }
}

TEST(Band, SoftEdgesAreAsWideAsTheySay) {
    const auto& levels = pyramid().levels();
    const double edge = levels[8].wavelength;
    const std::vector<double> hard = share(Unit::wavelength, 0, edge), soft = share(Unit::wavelength, 0, edge, 1);
    for (std::size_t k = 0; k < soft.size(); ++k) {
        // Half an octave to each side.
        const bool inside = levels[k + 1].wavelength < edge / std::sqrt(2.0);
        const bool outside = levels[k].wavelength > edge * std::sqrt(2.0);
        EXPECT_TRUE(inside || outside ? std::abs(soft[k] - hard[k]) < 1e-12 : soft[k] > 0 && soft[k] < 1) << k;
        EXPECT_LE(soft[k], (k > 0 ? soft[k - 1] : 1) + 1e-12);
    }
}

TEST(Band, GainsAreOneOutside) {
    const Band band{Unit::level, 2.5, 7, 0.3};
    const std::vector<double> s = band_share(pyramid(), band, diagonal()),
                              g = band_gains(pyramid(), band, diagonal(), 3);
    for (std::size_t k = 0; k < s.size(); ++k) EXPECT_DOUBLE_EQ(g[k], 1 + 2 * s[k]);
    for (const double one : band_gains(pyramid(), band, diagonal(), 1)) EXPECT_EQ(one, 1);
}

TEST(Band, RefusesLimitsThatMakeNoSense) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (const Unit unit : {Unit::wavelength, Unit::wavelength_percent, Unit::level, Unit::vertices}) {
        EXPECT_THROW(share(unit, nan, 1), InputError);
        EXPECT_THROW(share(unit, 1, nan), InputError);
        EXPECT_THROW(share(unit, inf, 1), InputError);
        EXPECT_THROW(share(unit, 0, inf), InputError);
        EXPECT_THROW(share(unit, 5, 5), InputError);
        EXPECT_THROW(share(unit, -1, 5), InputError);
        EXPECT_THROW(share(unit, 5, -1), InputError);
        for (const double softness : {-0.1, nan, inf})
            EXPECT_THROW(share(unit, unit == Unit::vertices ? 5 : 1, unit == Unit::vertices ? 1 : 5, softness),
                         InputError);
    }
    EXPECT_THROW(share(Unit::wavelength, 2, 1), InputError);
    EXPECT_THROW(share(Unit::level, 7, 2), InputError);
    EXPECT_THROW(share(Unit::vertices, 1000, 2000), InputError);
}

TEST(Band, DefaultsAreInOrderAndReachSomething) {
    for (const auto& [name, mesh] : every_class()) {
        SCOPED_TRACE(name);
        const Layer l = layer_of(mesh);
        const Pyramid p(l, PyramidOptions(), Progress());
        for (const Unit unit : {Unit::wavelength, Unit::wavelength_percent, Unit::level, Unit::vertices}) {
            const std::vector<double> s = band_share(p, default_band(l, unit), box_diagonal(l));
            const double cutoff = default_cutoff(l, unit);
            EXPECT_GT(cutoff, 0);
            double sum = 0;
            for (const double x : s) sum += x;
            EXPECT_TRUE(mesh.positions.size() < 1000 || sum > 1) << "unit " << static_cast<int>(unit);
        }
    }
}

}  // namespace multires
