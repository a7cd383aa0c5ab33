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

TEST(Array, MoreThanThereIsThrows) {
    EXPECT_THROW(Array<std::uint8_t>(std::size_t{1} << 60), std::bad_alloc);
    EXPECT_EQ(Array<int>(megabyte, 7).back(), 7);
}

}  // namespace multires
