#pragma once

#include "base/progress.h"
#include "mesh/mesh.h"

#include <cstdint>
#include <vector>

namespace multires {

/// A smooth function on the surface that is 1 on a region, 0 beyond a distance from it, and in between
/// 1/2 - 1/2 cos(pi t) of the harmonic function t (Guskov et al. 1999, section 4.3, who relax and subdivide where this
/// solves): C1 at both borders. Exactly 0 and 1 outside and inside.
/// @param inside    #V, 1 for the vertices of the region
/// @param distance  along edges, mesh units, >= 0; 0: no vertex lies in between
/// Cost: O(n log n) in the vertices in between, and a solve.
std::vector<double> falloff(const Mesh& mesh, const std::vector<std::uint8_t>& inside, double distance,
                            const Progress& progress);

}  // namespace multires
