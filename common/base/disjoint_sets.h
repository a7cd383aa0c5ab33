#pragma once

#include "base/array.h"
#include "base/index.h"

#include <cstdint>
#include <numeric>

namespace multires {

/// Union-find over 0 .. n-1 with parity: two elements of a set are known to lie on the same side or on opposite sides
/// of it (faces that agree in orientation or not). Callers that need no sides leave them out.
/// Cost: nearly constant per call (path halving).
class DisjointSets {
public:
    struct Place {
        Index root;         ///< the same for all elements of a set, and no other
        std::uint8_t side;  ///< 0 or 1: relative to the root
    };

    explicit DisjointSets(Index n) : parent_(n), side_(n, 0) { std::iota(parent_.begin(), parent_.end(), 0); }

    Place find(Index i) {
        std::uint8_t side = 0;
        while (parent_[i] != i) {
            side_[i] ^= side_[parent_[i]];
            parent_[i] = parent_[parent_[i]];
            side ^= side_[i];
            i = parent_[i];
        }
        return {i, side};
    }

    /// Joins the sets of i and j, which lie on opposite sides or on the same one; the root of i's set stays a root.
    /// @returns false if i and j were known to lie otherwise
    bool join(Index i, Index j, bool opposite = false) {
        const Place a = find(i), b = find(j);
        const std::uint8_t side = a.side ^ b.side ^ static_cast<std::uint8_t>(opposite);
        if (a.root == b.root) return side == 0;
        parent_[b.root] = a.root;
        side_[b.root] = side;
        return true;
    }

private:
    Array<Index> parent_;
    Array<std::uint8_t> side_;
};

}  // namespace multires
