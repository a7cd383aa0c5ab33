#pragma once

#include "mesh/mesh.h"

#include <cmath>

namespace multires {

/// The angle between two vectors of any length, radians in [0, pi]; 0 if one of them is 0. Accurate near 0 and pi, too.
inline double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace multires
