#pragma once

#include "mesh/mesh.h"

#include <array>
#include <cstdint>

namespace multires {

/// 128 bits: the same for the same contents, and in practice never for others.
using ContentHash = std::array<std::uint64_t, 2>;

/// Hash of positions, bit for bit, and faces.
/// Cost: linear, as fast as memory is read.
ContentHash shape_hash(const Positions& positions, const Faces& faces);

}  // namespace multires
