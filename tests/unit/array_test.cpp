#include "base/array.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace multires {

namespace {

constexpr std::size_t megabyte = std::size_t{1} << 20;

}  // namespace

TEST(Array, NewElementsMayBeSetAndOldOnesStay) {
    for (const std::size_t size : {std::size_t{1}, std::size_t{1000}, megabyte}) {
        Array<double> a(size, 1.5);
        a.resize(3 * size);
        EXPECT_EQ(a[0], 1.5);
        EXPECT_EQ(a[size - 1], 1.5);
        a.back() = 2;
        a.shrink_to_fit();
        const Array<double> b = a;
        EXPECT_EQ(b[size - 1], 1.5);
        EXPECT_EQ(b.back(), 2);
    }
}

TEST(Array, BlocksAreUsedAgainAndNeverTwiceAtOnce) {
    const BlockReuse reuse;
    Array<std::uint8_t> first(40 * megabyte, 1);
    const std::uint8_t* const at = first.data();
    first = Array<std::uint8_t>();
    {
        const BlockReuse nested;
        Array<std::uint8_t> a(10 * megabyte + 5, 2), b(10 * megabyte, 3), c(30 * megabyte, 4);
        EXPECT_EQ(a.data(), at);
        EXPECT_EQ(b.data(), at + 12 * megabyte);  // blocks begin where huge pages do
        EXPECT_TRUE(c.data() + c.size() <= at || c.data() >= at + 40 * megabyte);
        for (const Array<std::uint8_t>* x : {&a, &b, &c}) EXPECT_EQ(x->front(), x->back());
        EXPECT_NE(a.back(), b.front());
    }
    Array<std::uint8_t> small(1000, 5), large(100 * megabyte, 6);
    EXPECT_EQ(small.back() + large.back(), 11);
}

TEST(Array, MoreThanThereIsThrows) {
    const BlockReuse reuse;
    EXPECT_THROW(Array<std::uint8_t>(std::size_t{1} << 60), std::bad_alloc);
    EXPECT_EQ(Array<int>(megabyte, 7).back(), 7);
}

}  // namespace multires
