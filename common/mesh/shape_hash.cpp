#include "mesh/shape_hash.h"

#include "base/hash.h"

namespace multires {

ContentHash shape_hash(const Positions& positions, const Faces& faces) {
    Hash hash;
    hash.add(std::array<std::uint64_t, 1>{positions.size()});
    hash.add(positions.data(), positions.size() * sizeof(Vec3));
    hash.add(faces);
    return hash.bits128();
}

}  // namespace multires
