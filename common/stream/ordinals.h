#pragma once

#include "mesh/layer.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace multires::stream {

/// How numbers of an attribute are kept.
enum class Storage : std::uint8_t { byte = 1, single = 4, full = 8 };

inline int width_of(Storage s) { return static_cast<int>(s); }

namespace detail {

template <class Real, class Bits>
std::int64_t ordinal(Real x) {
    Bits bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    constexpr Bits sign = static_cast<Bits>(1) << (8 * sizeof(Bits) - 1);
    return static_cast<std::int64_t>(bits & sign ? static_cast<Bits>(~bits) : static_cast<Bits>(bits | sign));
}

template <class Real, class Bits>
Real real(std::int64_t ordinal) {
    Bits bits = static_cast<Bits>(ordinal);
    constexpr Bits sign = static_cast<Bits>(1) << (8 * sizeof(Bits) - 1);
    bits = bits & sign ? static_cast<Bits>(bits ^ sign) : static_cast<Bits>(~bits);
    Real x = 0;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

}  // namespace detail

/// A whole number that grows with x and tells all bits of it: differences of near numbers are small.
inline std::int64_t ordinal(double x, Storage s) {
    if (s == Storage::byte) return static_cast<std::int64_t>(x);
    if (s == Storage::single) return detail::ordinal<float, std::uint32_t>(static_cast<float>(x));
    return detail::ordinal<double, std::uint64_t>(x);
}

/// The number with that ordinal, whose bits beyond the storage's do not matter.
inline double real(std::int64_t ordinal, Storage s) {
    if (s == Storage::byte) return static_cast<double>(static_cast<std::uint8_t>(ordinal));
    if (s == Storage::single) return detail::real<float, std::uint32_t>(ordinal);
    return detail::real<double, std::uint64_t>(ordinal);
}

/// True if storing a number changes no bit of it.
inline bool fits(double x, Storage s) {
    const double y = s == Storage::byte && !(x >= 0 && x <= 255) ? -1 : real(ordinal(x, s), s);
    return detail::ordinal<double, std::uint64_t>(x) == detail::ordinal<double, std::uint64_t>(y);
}

/// The smallest storage that changes none of some numbers.
template <class Values>
Storage storage_of(const Values& values) {
    Storage s = Storage::byte;
    for (const double x : values)
        while (s != Storage::full && !fits(x, s)) s = s == Storage::byte ? Storage::single : Storage::full;
    return s;
}

}  // namespace multires::stream
