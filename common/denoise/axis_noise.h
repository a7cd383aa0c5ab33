#pragma once

#include "denoise/energies.h"

#include <optional>

namespace multires {

/// Noise along one axis of space, as of a depth camera: along the normals there is most of it where the surface faces
/// the axis, and none where it is parallel to it.
struct AxisNoise {
    Vec3 axis;             ///< of length 1
    double deviation = 0;  ///< mesh units
    double across = 0;     ///< deviation in other directions, at most
};

/// Fits the energies of third details by n . C n + share x bends, with the normals n and a covariance C, the same
/// everywhere, by least relative squares. It is an axis if this explains the energies better than the same noise
/// for all directions does, and C has one large eigenvalue.
/// @param energy  of third details, of the vertices `inner`
/// @param bends   of the same vertices
/// Cost: linear
std::optional<AxisNoise> axis_noise(const Neighbours& near, const Array<Vec3>& normal, const std::vector<Index>& inner,
                                    const Energies& energy, const Energies& bends);

}  // namespace multires
