#pragma once

#include "denoise/neighbours.h"
#include "mesh/mesh.h"

namespace multires {

/// The deviation of noise along the normals at each vertex, mesh units, if it clearly varies over the surface, as that
/// of range scanners does with the distance: from first and third differences along smoothed normals (local_noise.h).
/// @returns  #V, or nothing
/// Cost: linear, about 100 passes over the neighbours where it does not vary
std::vector<double> varying_noise(const Faces& faces, const Positions& positions, const Incidence& at,
                                  const Neighbours& near);

}  // namespace multires
