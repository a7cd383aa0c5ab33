#pragma once

#include "base/angles.h"
#include "base/random.h"
#include "mesh/mesh.h"

#include <cmath>
#include <cstdint>

namespace multires::shapes {

/// Random numbers that are the same with every compiler and standard library.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() { return random_bits(state_ += random_step); }

    /// Uniform in [0, 1).
    double uniform() { return unit_interval(bits()); }

    /// Uniform in [low, high).
    double uniform(double low, double high) { return low + (high - low) * uniform(); }

    bool chance(double probability) { return uniform() < probability; }

    /// Uniform on the unit sphere.
    Vec3 direction() {
        const double z = uniform(-1, 1), angle = uniform(0, 2 * pi), r = std::sqrt(1 - z * z);
        return {r * std::cos(angle), r * std::sin(angle), z};
    }

private:
    std::uint64_t state_;
};

}  // namespace multires::shapes
