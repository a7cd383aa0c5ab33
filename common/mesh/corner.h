#pragma once

#include "mesh/mesh.h"

#include <algorithm>
#include <cmath>

namespace multires {

/// How sharply a curve turns where it comes along one edge and goes on along another: 1 - cos of the angle, in [0, 2];
/// 0 if an edge has no length.
inline double turn(const Vec3& comes, const Vec3& goes) {
    const double lengths = std::sqrt(comes.squaredNorm() * goes.squaredNorm());
    return lengths > 0 ? 1 - comes.dot(goes) / lengths : 0;
}

/// How much of a corner a turn is beside another, in [0, 1]: 1 from 60 degrees on, if the curve is straight there. 0 on
/// round curves, and where a single vertex sticks out of a straight line: that turns by twice as much as beside it, and
/// 1 - cos 2 a is at most 4 (1 - cos a).
inline double corner_share(double turn, double beside) { return std::clamp(2 * (turn - 4 * beside), 0.0, 1.0); }

}  // namespace multires
