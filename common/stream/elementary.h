#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

/// Functions made of basic operations alone, the same on all machines; in line, for they are called a hundred times a
/// vertex.
namespace multires::stream {

/// 2^exponent of a whole number, -1022 < exponent < 1024.
inline double power_of_two(double exponent) {
    exponent += 4503599627370496.0 + 1023;  // 2^52: the lowest bits are those of the sum
    std::uint64_t bits = 0;
    std::memcpy(&bits, &exponent, sizeof bits);
    bits <<= 52;
    double out = 0;
    std::memcpy(&out, &bits, sizeof out);
    return out;
}

/// x / 2^exponent in [1, 2), of a positive number that is not denormal.
inline double mantissa(double x, int& exponent) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    exponent = static_cast<int>(bits >> 52 & 2047) - 1023;
    bits = (bits & 0x000fffffffffffffU) | 0x3ff0000000000000U;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

/// e^x for |x| <= 30 or so, to 1e-9. Without branches: loops take two at a time.
inline double exponential(double x) {
    x = x > -40 ? x : -40;
    x = x < 40 ? x : 40;
    const double steps = static_cast<double>(static_cast<int>(x * 1.4426950408889634 + 64.5) - 64);
    const double r = x - steps * 0.6931471805599453;
    const double rr = r * r;  // |r| < 0.35: seven terms are good to 1e-8
    const double sum = 1 + r + rr * (0.5 + r / 6 + rr * (1.0 / 24 + r / 120 + rr * (1.0 / 720)));
    return sum * power_of_two(steps);
}

/// log2 x of x > 0, to 1e-7.
inline double logarithm(double x) {
    int exponent = 0;
    double m = mantissa(x, exponent);
    const bool above = m > 1.4142135623730951;  // no branch: which it is cannot be foreseen
    m = above ? m * 0.5 : m;
    exponent += static_cast<int>(above);
    const double z = (m - 1) / (m + 1), zz = z * z;
    return exponent + 2.8853900817779268 * z * (1 + zz * (1.0 / 3 + zz * (0.2 + zz * (1.0 / 7 + zz / 9))));
}

/// floor(per_octave log2 x) for per_octave 1, 2 or 3; far down for x <= 0.
inline int octave_steps(double x, int per_octave) {
    // Fractions of 2^(1/2), 2^(1/3) and 2^(2/3): compared as whole numbers, which takes no branches.
    constexpr std::uint64_t half = 0x6a09e667f3bcd, third = 0x428a2f98d728b, thirds = 0x965fea53d6e3d;
    if (!(x > 0)) return -1000;
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    const int octave = static_cast<int>(bits >> 52) - 1023;
    bits &= 0x000fffffffffffffU;
    if (per_octave == 2) return 2 * octave + static_cast<int>(bits >= half);
    if (per_octave == 3) return 3 * octave + static_cast<int>(bits >= third) + static_cast<int>(bits >= thirds);
    return octave;
}

}  // namespace multires::stream
