#pragma once

#include "mesh/mesh.h"

#include <cstring>

namespace multires {

/// Key of a float that is not negative: orders like the float.
inline std::uint32_t radix_key(float value) {
    std::uint32_t key;
    std::memcpy(&key, &value, sizeof key);
    return key;
}

/// Indices in stable order of their keys, those with key `leave_out` left out. Linear.
inline std::vector<Index> sorted_by_key(const std::vector<std::uint32_t>& key, std::uint32_t leave_out) {
    constexpr int bits = 11, buckets = 1 << bits, passes = 3;
    struct Item {
        std::uint32_t key;
        Index index;
    };
    std::vector<Item> items;
    items.reserve(key.size());
    std::array<std::array<Index, buckets>, passes> count{};
    for (std::size_t i = 0; i < key.size(); ++i) {
        if (key[i] == leave_out) continue;
        items.push_back({key[i], static_cast<Index>(i)});
        for (int p = 0; p < passes; ++p) ++count[p][key[i] >> (p * bits) & (buckets - 1)];
    }
    std::vector<Item> other(items.size());
    for (int p = 0; p < passes; ++p) {
        Index sum = 0;
        for (Index& c : count[p]) {
            const Index here = c;
            c = sum;
            sum += here;
        }
        for (const Item& item : items) other[count[p][item.key >> (p * bits) & (buckets - 1)]++] = item;
        items.swap(other);
    }
    std::vector<Index> order(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) order[i] = items[i].index;
    return order;
}

}  // namespace multires
