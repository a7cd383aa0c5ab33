#pragma once

#include "base/array.h"
#include "base/index.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace multires {

/// Key of a float that is not negative: orders like the float.
inline std::uint32_t radix_key(float value) {
    std::uint32_t key;
    std::memcpy(&key, &value, sizeof key);
    return key;
}

/// Key of a number that is not negative, infinity allowed: orders the other way round.
inline std::uint64_t falling_radix_key(double value) {
    std::uint64_t key;
    std::memcpy(&key, &value, sizeof key);
    return ~key;
}

/// Some indices in stable order of their keys, which are 32 or 64 bits. Linear.
template <class Key>
std::vector<Index> sorted_by_key(std::vector<Index> indices, const Array<Key>& key) {
    constexpr int bits = 11, buckets = 1 << bits, passes = (8 * sizeof(Key) + bits - 1) / bits;
    struct Item {
        Key key;
        Index index;
    };
    Array<Item> items(indices.size()), other(indices.size());
    std::array<std::array<Index, buckets>, passes> count{};
    const auto digit = [](Key k, int pass) { return static_cast<std::size_t>(k >> (pass * bits)) & (buckets - 1); };
    for (std::size_t i = 0; i < indices.size(); ++i) {
        items[i] = {key[indices[i]], indices[i]};
        for (int p = 0; p < passes; ++p) ++count[p][digit(items[i].key, p)];
    }
    for (int p = 0; p < passes; ++p) {
        Index sum = 0;
        for (Index& c : count[p]) {
            const Index here = c;
            c = sum;
            sum += here;
        }
        for (const Item& item : items) other[count[p][digit(item.key, p)]++] = item;
        items.swap(other);
    }
    for (std::size_t i = 0; i < items.size(); ++i) indices[i] = items[i].index;
    return indices;
}

/// All indices but those with the key `leave_out`, in stable order of their keys. Linear.
inline std::vector<Index> sorted_by_key(const Array<std::uint32_t>& key, std::uint32_t leave_out) {
    std::vector<Index> indices;
    indices.reserve(key.size());
    for (std::size_t i = 0; i < key.size(); ++i)
        if (key[i] != leave_out) indices.push_back(static_cast<Index>(i));
    return sorted_by_key(std::move(indices), key);
}

}  // namespace multires
