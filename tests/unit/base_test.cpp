#include "base/angles.h"
#include "base/buckets.h"
#include "base/disjoint_sets.h"
#include "base/hash.h"
#include "base/median.h"
#include "base/random.h"
#include "base/reduce.h"

#include "fixtures.h"

#include <cmath>

// The small parts of base/, each against its definition.

namespace multires {

TEST(Angles, ConvertBothWays) {
    EXPECT_EQ(pi, std::acos(-1.0));
    EXPECT_DOUBLE_EQ(radians(180), pi);
    EXPECT_DOUBLE_EQ(degrees(radians(37)), 37);
}

TEST(Buckets, HoldEveryItemOnceInItsOrder) {
    shapes::Random random(3);
    std::vector<Index> bucket_of(1000);
    for (Index& b : bucket_of) b = static_cast<Index>(random.bits() % 70);
    const Buckets<Index> buckets(71, 1000, [&](Index i) { return bucket_of[i]; });  // the last one is empty
    ASSERT_EQ(buckets.size(), 71);
    EXPECT_EQ(buckets.items(), 1000);
    for (Index b = 0; b < buckets.size(); ++b) {
        std::vector<Index> expected;
        for (Index i = 0; i < 1000; ++i)
            if (bucket_of[i] == b) expected.push_back(i);
        EXPECT_EQ(std::vector<Index>(buckets[b].begin(), buckets[b].end()), expected);
        EXPECT_EQ(buckets[b].size(), static_cast<Index>(expected.size()));
    }
    EXPECT_EQ(Buckets<Index>().size(), 0);
    EXPECT_EQ(Buckets<Index>(0, 0, [](Index) { return 0; }).size(), 0);
}

TEST(Buckets, AreTheSameInAnyNumberOfParts) {
    shapes::Random random(4);
    std::vector<Index> bucket_of(1000);
    for (Index& b : bucket_of) b = static_cast<Index>(random.bits() % 70);
    const Buckets<Index> whole(71, 1000, [&](Index i) { return bucket_of[i]; });
    for (const int threads : {1, 3})
        for (const Index parts : {1, 2, 3, 4}) {
            const fixtures::Threads scope(threads);
            const auto buckets = Buckets<Index>::in_parts(71, parts, [&](Index part, const auto& put) {
                for (Index i = 1000 * part / parts; i < 1000 * (part + 1) / parts; ++i) put(bucket_of[i], i);
            });
            ASSERT_EQ(buckets.size(), whole.size());
            EXPECT_EQ(buckets.items(), whole.items());
            for (Index b = 0; b < buckets.size(); ++b)
                EXPECT_TRUE(std::equal(buckets[b].begin(), buckets[b].end(), whole[b].begin(), whole[b].end()));
        }
}

TEST(DisjointSets, RandomJoinsGiveTheComponentsAndSidesOfAColouring) {
    constexpr Index n = 200;
    shapes::Random random(5);
    for (int round = 0; round < 20; ++round) {
        std::vector<std::uint8_t> colour(n);
        for (std::uint8_t& c : colour) c = random.chance(0.5) ? 1 : 0;
        DisjointSets sets(n);
        std::vector<Index> component(n);  // relabelled by brute force at each join
        for (Index i = 0; i < n; ++i) component[i] = i;
        for (int k = 0; k < 10 * round; ++k) {
            const Index i = static_cast<Index>(random.bits() % n), j = static_cast<Index>(random.bits() % n);
            EXPECT_TRUE(sets.join(i, j, colour[i] != colour[j]));
            const Index from = component[j], to = component[i];
            std::replace(component.begin(), component.end(), from, to);
        }
        for (Index i = 0; i < n; ++i)
            for (Index j = 0; j < n; ++j) {
                const auto a = sets.find(i), b = sets.find(j);
                ASSERT_EQ(a.root == b.root, component[i] == component[j]);
                if (a.root != b.root) continue;
                ASSERT_EQ(a.side == b.side, colour[i] == colour[j]);
                ASSERT_EQ(sets.join(i, j, colour[i] == colour[j]), false);
            }
    }
}

TEST(UpperMedian, IsTheElementInTheMiddleOfTheSortedValues) {
    shapes::Random random(7);
    for (std::size_t n = 1; n < 30; ++n) {
        std::vector<double> values(n);
        for (double& x : values) x = static_cast<double>(random.bits() % 8);  // with ties
        std::vector<double> sorted = values;
        std::sort(sorted.begin(), sorted.end());
        EXPECT_EQ(upper_median(values), sorted[n / 2]);
        EXPECT_LE(*std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n / 2 + 1)),
                  sorted[n / 2]);
    }
}

TEST(Random, IsSplitmix64) {
    EXPECT_EQ(random_bits(random_step), 0xe220a8397b1dcdafu);  // its first number after seed 0
    std::uint64_t counter = 1234567;
    EXPECT_EQ(random_bits(counter += random_step), 6457827717110365317u);
    EXPECT_EQ(random_bits(counter += random_step), 3203168211198807973u);
    EXPECT_EQ(unit_interval(0), 0);
    EXPECT_EQ(unit_interval(~std::uint64_t{0}), 1 - 0x1p-53);
}

TEST(Hash, InPartsIsTheHashOfTheWhole) {
    const std::vector<double> numbers = {1, 2, -0.5, 1e300};
    const std::array<std::int32_t, 3> indices = {7, -1, 4};
    std::vector<unsigned char> bytes(sizeof(double) * numbers.size() + sizeof indices);
    std::copy_n(reinterpret_cast<const unsigned char*>(numbers.data()), 4 * sizeof(double), bytes.begin());
    std::copy_n(reinterpret_cast<const unsigned char*>(indices.data()), sizeof indices, bytes.end() - sizeof indices);
    Hash hash;
    EXPECT_TRUE(hash.empty());
    EXPECT_EQ(hash.bits64(), 0x2d06800538d394c2u);  // of nothing, as xxhash's own tests say
    hash.add(std::vector<int>());
    EXPECT_TRUE(hash.empty());
    hash.add(numbers);
    hash.add(indices);
    EXPECT_FALSE(hash.empty());
    EXPECT_EQ(hash.bits64(), XXH3_64bits(bytes.data(), bytes.size()));
    const XXH128_hash_t whole = XXH3_128bits(bytes.data(), bytes.size());
    EXPECT_EQ(hash.bits128(), (std::array<std::uint64_t, 2>{whole.low64, whole.high64}));
}

TEST(Fold, SumsMeansAndLengthsAreThoseOfOnePass) {
    shapes::Random random(11);
    std::vector<double> x(20000);
    for (double& v : x) v = random.uniform(-1, 3);
    long double sum = 0, squares = 0;
    for (const double v : x) sum += v, squares += static_cast<long double>(v) * v;
    double bits[2][2];
    for (const int threads : {1, 2}) {
        const fixtures::Threads scope(threads);
        const auto mean = chunked_fold<Mean>(x.size(), [&](Mean& part, std::size_t i) { part.add(x[i]); });
        const auto lengths =
            chunked_fold<Lengths>(x.size(), [&](Lengths& part, std::size_t i) { part.add(x[i] * x[i]); });
        EXPECT_NEAR(mean.value(), static_cast<double>(sum / x.size()), 1e-14);
        EXPECT_NEAR(lengths.rms(), static_cast<double>(std::sqrt(squares / x.size())), 1e-14);
        EXPECT_EQ(lengths.largest(), *std::max_element(x.begin(), x.end()));
        bits[threads - 1][0] = mean.value(), bits[threads - 1][1] = lengths.rms();
    }
    EXPECT_EQ(bits[0][0], bits[1][0]);
    EXPECT_EQ(bits[0][1], bits[1][1]);
    EXPECT_EQ(chunked_fold<Mean>(0, [](Mean&, std::size_t) {}).value(), 0);
    Lengths weighted;
    weighted.add(9, 1);
    weighted.add(1, 3);
    EXPECT_DOUBLE_EQ(weighted.rms(), std::sqrt(3.0));
}

TEST(Sums, RanksAndOffsetsAreThoseOfOnePass) {
    shapes::Random random(12);
    for (const Index count : {0, 1, 4096, 20000})
        for (const int threads : {1, 2}) {
            const fixtures::Threads scope(threads);
            Array<Index> sizes(count), rank(count, -1);
            for (Index& size : sizes) size = static_cast<Index>(random.bits() % 9);
            std::vector<Index> offset(count), ranks(count);
            std::partial_sum(sizes.begin(), sizes.end(), offset.begin());
            Index ranked = 0;
            for (Index i = 0; i < count; ++i) ranks[i] = ranked, ranked += sizes[i] > 4;
            EXPECT_EQ(ranked_for(
                          count, [&](Index i) { return sizes[i] > 4; }, [&](Index i, Index r) { rank[i] = r; }),
                      ranked);
            EXPECT_TRUE(std::equal(rank.begin(), rank.end(), ranks.begin(), ranks.end()));
            add_up(sizes);
            EXPECT_TRUE(std::equal(sizes.begin(), sizes.end(), offset.begin(), offset.end()));
        }
}

}  // namespace multires
