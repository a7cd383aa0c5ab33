#pragma once

#include "mesh/mesh.h"

#include <cmath>
#include <cstdint>

namespace multires::shapes {

/// Random numbers that are the same with every compiler and standard library (splitmix64, Steele et al. 2014).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }

    /// Uniform in [0, 1).
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

    /// Uniform in [low, high).
    double uniform(double low, double high) { return low + (high - low) * uniform(); }

    bool chance(double probability) { return uniform() < probability; }

    /// Uniform on the unit sphere.
    Vec3 direction() {
        const double z = uniform(-1, 1), angle = uniform(0, 2 * std::acos(-1.0)), r = std::sqrt(1 - z * z);
        return {r * std::cos(angle), r * std::sin(angle), z};
    }

private:
    std::uint64_t state_;
};

}  // namespace multires::shapes
