#pragma once

#include "denoise/neighbours.h"

namespace multires {

/// From a vertex on a crease to where the planes of its two sides meet, if it stands out of both; otherwise 0.
///
/// The faces around, its own not among them, are of one side or the other by their normals, along the direction in
/// which these vary most. Each side's plane has the least absolute deviations of its vertices (iteratively reweighted
/// least squares, Schlossmacher 1973), which a few that are off do not turn. The vertex stands out if it is off both by
/// more than eight times as much as three quarters of those up to two edges away are off the nearer one, so nothing is
/// known of corners and of creases that bend. It is on the crease if neighbours are on one plane alone, and others on
/// the other. Creases of less than 30 degrees have no certain place.
///
/// @returns  mesh units
/// Cost: O(r log r) for r vertices up to two edges away
Vec3 to_crease(const Faces& faces, const Positions& p, const Incidence& at, const Neighbours& near, Index v);

}  // namespace multires
