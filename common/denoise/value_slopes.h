#pragma once

#include "denoise/neighbours.h"
#include "mesh/mesh.h"

namespace multires {

/// How values rise around each vertex: the plane with the least sum of absolute deviations from the values up to two
/// edges away, its own not among them (least_deviations.h). A few of them that are far off do not turn it.
/// @param normals  #V by 3, of unit length
/// @param values   #V by width, finite
/// @returns        #V by width: gradients within the surface; 0 where there are too few neighbours to tell
/// Cost: linear, some 150 operations a vertex, channel and neighbour; parallel
std::vector<Vec3> value_slopes(const Neighbours& near, const Positions& positions, const Positions& normals,
                               const std::vector<double>& values, int width);

}  // namespace multires
