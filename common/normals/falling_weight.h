#pragma once

#include <cstdint>
#include <cstring>

namespace multires {

/// exp(-x) for 0 <= x <= 700 with a relative error below 1e-8, inline: weights of neighbours are asked for by the
/// million.
inline double falling_weight(double x) {
    constexpr double log2_e = 1.4426950408889634, ln_2 = 0.6931471805599453;
    // A number near a half may be rounded either way.
    const int halvings = static_cast<int>(x * log2_e + 0.5);  // NOLINT(bugprone-incorrect-roundings)
    const double z = halvings * ln_2 - x;                     // at most ln 2 / 2 either way
    constexpr double c7 = 1.0 / 5040, c6 = 1.0 / 720, c5 = 1.0 / 120, c4 = 1.0 / 24, c3 = 1.0 / 6;
    const double z2 = z * z;  // pairs, so that they are computed at once
    const double series = (1 + z) + z2 * ((0.5 + c3 * z) + z2 * ((c4 + c5 * z) + z2 * (c6 + c7 * z)));
    const std::int64_t bits = (1023 - static_cast<std::int64_t>(halvings)) << 52;
    double power;
    std::memcpy(&power, &bits, sizeof power);
    return series * power;
}

}  // namespace multires
