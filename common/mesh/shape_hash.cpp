#include "mesh/shape_hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace multires {

ContentHash shape_hash(const Positions& positions, const Faces& faces) {
    XXH3_state_t state;
    XXH3_128bits_reset(&state);
    const auto add = [&](const void* data, std::size_t bytes) {
        if (bytes) XXH3_128bits_update(&state, data, bytes);
    };
    const std::uint64_t count = positions.size();
    add(&count, sizeof count);
    add(positions.data(), positions.size() * sizeof(Vec3));
    add(faces.data(), faces.size() * sizeof(Face));
    const XXH128_hash_t hash = XXH3_128bits_digest(&state);
    return {hash.low64, hash.high64};
}

}  // namespace multires
