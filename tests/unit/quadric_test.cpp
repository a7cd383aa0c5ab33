#include "hierarchy/quadric.h"

#include "base/radix_sort.h"

#include "random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace multires {
namespace {

/// Planes kept as planes: what a quadric stands for.
struct Planes {
    struct Plane {
        Vec3 normal, point;
    };
    std::vector<Plane> planes;

    double at(const Vec3& x) const {  // |n| (unit n . (x - p))^2
        double sum = 0;
        for (const auto& [n, p] : planes) sum += std::pow(n.dot(x - p), 2) / n.norm();
        return sum;
    }
};

struct Owned {
    Vec3 owner;
    Quadric quadric{};
    Planes planes;
};

Owned random_owner(shapes::Random& random, const Vec3& near) {
    Owned o{near + random.direction(), {}, {}};
    for (int k = 0; k < 6; ++k) {
        const Vec3 n = random.direction() * random.uniform(0.1, 3);
        o.quadric.add_plane(n, n.norm());
        o.planes.planes.push_back({n, o.owner});
    }
    return o;
}

}  // namespace

TEST(Quadric, IsTheSumOfSquaredDistancesAfterMoves) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        shapes::Random random(seed);
        const Vec3 near = (seed % 2) * 1e6 * random.direction();  // nothing is lost far from zero
        // A chain of collapses: each owner takes in the one before, which has taken in others.
        Owned sum = random_owner(random, near);
        for (int k = 0; k < 20; ++k) {
            Owned next = random_owner(random, near);
            next.quadric.add_moved(sum.quadric, sum.owner - next.owner);
            next.planes.planes.insert(next.planes.planes.end(), sum.planes.planes.begin(), sum.planes.planes.end());
            sum = std::move(next);
        }
        for (int k = 0; k < 10; ++k) {
            const Vec3 d = 3 * random.direction(), x = sum.owner + d;
            const Vec3 exactly = x - sum.owner;
            const double expected = sum.planes.at(x);
            // Positions near 1e6 are rounded to 1e-10 of the distances themselves.
            EXPECT_NEAR(sum.quadric.at(exactly), expected, expected * (seed % 2 ? 1e-8 : 1e-12)) << "seed " << seed;
        }
    }
}

TEST(Quadric, WeighsByTheLengthOfItsNormals) {
    Quadric q{};
    q.add_plane({0, 0, 2}, 2);
    q.add_plane({0, 3, 0}, 3);
    EXPECT_DOUBLE_EQ(q.weight(), 5);
    EXPECT_DOUBLE_EQ(q.at({7, 1, 0}), 3);
    EXPECT_DOUBLE_EQ(q.at({7, 0, 2}), 8);
    Quadric moved{};
    moved.add_moved(q, {0, 0, 1});
    EXPECT_DOUBLE_EQ(moved.weight(), 5);
    EXPECT_DOUBLE_EQ(moved.at({0, 0, 1}), 0);
    EXPECT_DOUBLE_EQ(moved.at({0, 0, 0}), 2);
}

TEST(RadixSort, SortsStablyAndLeavesOut) {
    constexpr std::uint32_t out = std::numeric_limits<std::uint32_t>::max();
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        shapes::Random random(seed);
        Array<std::uint32_t> key(random.bits() % 3000);
        // Few different keys, keys that differ in one of the three digits only, and any keys.
        const int shift = static_cast<int>(seed % 4) * 8;
        for (auto& k : key)
            k = seed % 4 == 3 ? static_cast<std::uint32_t>(random.bits()) : (random.bits() % 100) << shift;
        for (auto& k : key)
            if (random.chance(0.1)) k = out;
        std::vector<Index> expected;
        for (std::size_t i = 0; i < key.size(); ++i)
            if (key[i] != out) expected.push_back(static_cast<Index>(i));
        std::stable_sort(expected.begin(), expected.end(), [&](Index a, Index b) { return key[a] < key[b]; });
        EXPECT_EQ(sorted_by_key(key, out), expected) << "seed " << seed;
    }
    EXPECT_TRUE(sorted_by_key({}, out).empty());
    EXPECT_TRUE(sorted_by_key({out, out}, out).empty());
    EXPECT_EQ(sorted_by_key({out - 1, 0, out - 1}, out), (std::vector<Index>{1, 0, 2}));
}

TEST(RadixSort, SixtyFourBitsSortFallingNumbersInStableOrder) {
    shapes::Random random(41);
    std::vector<double> value(2000);
    for (double& x : value) x = random.chance(0.2) ? 0.25 * (random.bits() % 4) : std::exp(random.uniform(-700, 700));
    value[7] = std::numeric_limits<double>::infinity();
    Array<std::uint64_t> key(value.size());
    std::transform(value.begin(), value.end(), key.begin(), falling_radix_key);
    std::vector<Index> indices(value.size());
    std::iota(indices.begin(), indices.end(), 0);
    std::vector<Index> expected = indices;
    std::stable_sort(expected.begin(), expected.end(), [&](Index a, Index b) { return value[a] > value[b]; });
    EXPECT_EQ(sorted_by_key(indices, key), expected);
}

TEST(RadixSort, KeysOrderLikeFloats) {
    const float values[] = {0.0f,
                            std::numeric_limits<float>::denorm_min(),
                            1e-38f,
                            1e-10f,
                            0.5f,
                            1.0f,
                            1.0000001f,
                            1e10f,
                            std::numeric_limits<float>::max(),
                            std::numeric_limits<float>::infinity()};
    for (const float a : values)
        for (const float b : values) EXPECT_EQ(radix_key(a) < radix_key(b), a < b) << a << ' ' << b;
    EXPECT_LT(radix_key(std::numeric_limits<float>::infinity()), std::numeric_limits<std::uint32_t>::max());
}

}  // namespace multires
