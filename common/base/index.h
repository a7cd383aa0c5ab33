#pragma once

#include <cstdint>

namespace multires {

/// Index of a vertex, face or row. 32 bits: meshes hold at most 2^31-1 corners, checked at the boundary.
using Index = std::int32_t;

}  // namespace multires
