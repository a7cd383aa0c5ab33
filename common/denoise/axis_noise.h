#pragma once

#include "denoise/neighbours.h"

#include <optional>

namespace multires {

/// Noise along one axis of space, as of a depth camera: along the normals there is most of it where the surface faces
/// the axis, and none where it is parallel to it.
struct AxisNoise {
    Vec3 axis;             ///< of length 1
    double deviation = 0;  ///< mesh units
    double across = 0;     ///< deviation in other directions, at most
    double share = 1;      ///< of what such noise moves within the surface: so much of it is seen there
    double one_side = 0;   ///< 1 if the surface faces the axis from one side only, as terrain does, about 0 if closed
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

/// Third details d, where hardly any shape is left, of noise of covariance C, the same everywhere: on a surface with
/// normals n the mean of (n . d) d is C n, in units of what white noise of deviation 1 makes of d^2. Along the normal
/// that is how strong the noise looks there, across it what the noise's parts have in common, whose sign tells apart
/// axes that are alike from three planes, and which the sampling, however irregular, has no part in. C is fitted by
/// least squares, weighed by the energies around each vertex, so that creases hardly count. It is an axis if one
/// eigenvalue is large, and if the places within the surface show the noise, too: as much of it as goes with what is
/// seen along the normals (half as much to one and a half times as much), by 4.5 standard errors. Nothing is known of
/// noise that runs along the surface nearly everywhere.
/// Cost: linear, about 50 passes over the neighbours
std::optional<AxisNoise> axis_noise(const Neighbours& near, const Positions& p, const Array<Vec3>& normal,
                                    const std::vector<Index>& inner);

}  // namespace multires
