#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace multires::fuzz {

/// Reads a fuzzer's input; zeros after its end.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

    std::uint8_t byte() { return at_ < size_ ? data_[at_++] : 0; }
    bool ended() const { return at_ >= size_; }

    /// 0 .. most-1
    int below(int most) { return byte() % most; }

    /// A number from one byte: small multiples of 1/8, or one of those that break things.
    double number() {
        constexpr double inf = std::numeric_limits<double>::infinity();
        constexpr double special[] = {
            std::numeric_limits<double>::quiet_NaN(), inf, -inf, 1e30, -1e30, 1e-30, 1e300, -0.0, 1e6, 1e-7, 5e-324};
        constexpr int count = sizeof special / sizeof *special;
        const int b = byte();
        return b >= 256 - count ? special[b - (256 - count)] : (b - 120) / 8.0;
    }

private:
    const std::uint8_t* data_;
    std::size_t size_, at_ = 0;
};

/// Inputs that were not refused.
inline long worked = 0;

}  // namespace multires::fuzz

/// Stops with a core dump, in all kinds of builds: what fuzzers look for.
#define FUZZ_REQUIRE(condition)                                                                                        \
    do {                                                                                                               \
        if (!(condition)) __builtin_trap();                                                                            \
    } while (false)
