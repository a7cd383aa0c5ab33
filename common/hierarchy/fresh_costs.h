#pragma once

#include "hierarchy/collapse.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace multires::collapse {

/// Costs of collapses by the faces as they are: cost(vertex_quadric(v), 0, ...), to the last bit, for all targets of a
/// vertex with a closed ring at once. Arrays by coordinate and no branches, so that compilers use vector instructions.
class FreshCosts {
public:
    static bool takes(const Ring& ring) { return ring.closed() && ring.size <= most; }

    /// @param ring  one that takes() is true for
    FreshCosts(Index v, const Ring& ring, const Positions& p, double length_weight) : size_(ring.size) {
        const Vec3 at = p[v];
        for (Index j = 0; j < size_; ++j) {
            const Vec3& q = p[ring.vertex[j]];
            x_[j] = q[0] - at[0], y_[j] = q[1] - at[1], z_[j] = q[2] - at[2];
        }
        const Index padded = (size_ + 1) & ~1;
        for (Index j = size_; j <= padded; ++j) x_[j] = x_[0], y_[j] = y_[0], z_[j] = z_[0];
        sum_planes(padded);
        const double by_length = length_weight * (xx_ + yy_ + zz_);
        for (Index j = 0; j < padded; ++j) {
            const double x = x_[j], y = y_[j], z = z_[j];
            const double square =
                x * (xx_ * x + 2 * (xy_ * y + xz_ * z)) + y * (yy_ * y + 2 * (yz_ * z)) + z * (zz_ * z);
            cost_[j] = (square > 0 ? square : 0) + by_length * (x * x + y * y + z * z);
        }
    }

    double operator[](Index j) const { return cost_[j]; }

    /// The first of the least costs.
    Index cheapest() const {
        std::uint64_t least = bits(cost_[0]);
        Index at = 0;
        for (Index j = 1; j < size_; ++j) {
            const std::uint64_t now = bits(cost_[j]);  // of numbers that are not negative: orders like them
            at = now < least ? j : at;
            least = now < least ? now : least;
        }
        return at;
    }

private:
    static constexpr Index most = 30;

    static std::uint64_t bits(double cost) {
        std::uint64_t b;
        std::memcpy(&b, &cost, sizeof b);
        return b;
    }

    /// Adds the planes of the faces between entries j and j + 1 in their order.
    void sum_planes(Index padded) {
        double plane[6][most + 2];
        for (Index j = 0; j < padded; ++j) {
            const double a = y_[j] * z_[j + 1] - z_[j] * y_[j + 1], b = z_[j] * x_[j + 1] - x_[j] * z_[j + 1],
                         c = x_[j] * y_[j + 1] - y_[j] * x_[j + 1];
            const double length = std::sqrt(a * a + b * b + c * c);
            const double s = length > 0 ? 1 / length : 0;
            plane[0][j] = s * a * a, plane[1][j] = s * a * b, plane[2][j] = s * a * c;
            plane[3][j] = s * b * b, plane[4][j] = s * b * c, plane[5][j] = s * c * c;
        }
        for (Index j = 0; j < size_; ++j) {
            xx_ += plane[0][j], xy_ += plane[1][j], xz_ += plane[2][j];
            yy_ += plane[3][j], yz_ += plane[4][j], zz_ += plane[5][j];
        }
    }

    Index size_;
    double x_[most + 2], y_[most + 2], z_[most + 2], cost_[most + 2];
    double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
};

}  // namespace multires::collapse
