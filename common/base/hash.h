#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <type_traits>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace multires {

/// XXH3 of numbers, byte by byte, in the order they are added. For .cpp files only: it brings all of xxhash.h.
/// Cost: as fast as memory is read.
class Hash {
public:
    Hash() { XXH3_128bits_reset(&state_); }

    /// A vector, array or built-in array of numbers.
    template <class Values>
    void add(const Values& values) {
        using T = std::remove_cv_t<std::remove_reference_t<decltype(*std::data(values))>>;
        static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>,
                      "padding has no value");
        add(std::data(values), std::size(values) * sizeof(T));
    }
    void add(const void* data, std::size_t bytes) {
        if (bytes == 0) return;
        empty_ = false;
        XXH3_128bits_update(&state_, data, bytes);
    }

    bool empty() const { return empty_; }
    std::uint64_t bits64() const { return XXH3_64bits_digest(&state_); }
    std::array<std::uint64_t, 2> bits128() const {
        const XXH128_hash_t hash = XXH3_128bits_digest(&state_);
        return {hash.low64, hash.high64};
    }

private:
    XXH3_state_t state_;
    bool empty_ = true;
};

}  // namespace multires
