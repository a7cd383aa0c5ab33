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

/// Mean squares within the surface, mesh units.
struct Sideways {
    double before = 0;  ///< of the noise
    double after = 0;   ///< of what is expected to be left of it
};

/// Noise along an axis crosses the surface, where it is not seen; but how far it went there is known from how far it
/// went along the normals. What moved along them is moved on by the mean that the covariance of the noise gives, and by
/// the share of it for which the sampling becomes most even: where the axis was found by chance it does not.
/// @param own     deviation of the noise in other directions, mesh units
/// @param error   mean square error expected of the moves along the normals
/// @param normal  #V by 3
/// @param to      #V by 3: where the vertices are moved from `from`
Sideways move_along(const AxisNoise& axis, double own, double error, const Neighbours& near, const Array<Vec3>& normal,
                    const Positions& from, Positions& to);

/// Fits the energies of third details by n . C n + share x bends, with the normals n and a covariance C, the same
/// everywhere, by least relative squares. It is an axis if this explains the energies better than the same noise
/// for all directions does, and C has one large eigenvalue. Of few vertices (less than 900) the places within the
/// surface must show what such noise makes of them, too.
/// @param energy  of third details, of the vertices `inner`
/// @param bends   of the same vertices
/// Cost: linear
std::optional<AxisNoise> axis_noise(const Neighbours& near, const Positions& p, const Array<Vec3>& normal,
                                    const std::vector<Index>& inner, const Energies& energy, const Energies& bends);

}  // namespace multires
