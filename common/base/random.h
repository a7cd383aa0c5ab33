#pragma once

#include <cstdint>

/// Pseudo-random numbers from a counter (splitmix64, Steele et al. 2014): the same on every platform.
namespace multires {

/// What splitmix64 adds to its counter for each number.
constexpr std::uint64_t random_step = 0x9e3779b97f4a7c15u;

/// The two multiplications of splitmix64; the upper half of the bits is good already.
constexpr std::uint64_t scrambled(std::uint64_t z) {
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    return (z ^ z >> 27) * 0x94d049bb133111ebu;
}

/// The number of splitmix64 at this value of its counter.
constexpr std::uint64_t random_bits(std::uint64_t counter) {
    const std::uint64_t z = scrambled(counter);
    return z ^ z >> 31;
}

/// Uniform in [0, 1), from the upper 53 bits.
constexpr double unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

}  // namespace multires
