#pragma once

#include "denoise/neighbours.h"

#include <cstdint>

namespace multires {

/// Sets impulses back that planes do not show (without_spikes()), since the surface bends as much: each vertex is
/// compared with the quadric of least absolute deviations (iteratively reweighted least squares, Schlossmacher 1973)
/// from the vertices up to two edges away, its own not among them, along the mean normal there. A few of them that are
/// off do not turn it, and how far the others are from it is what is usual there. A vertex that is off by four times as
/// much moves onto it, unless that is four times as far as impulses in the quietest third of the surface usually are,
/// or half as far again as the farthest of those: then it is shape.
///
/// A mesh has impulses if more than 1.5 % of the vertices in the quietest third of the surface are off by more than
/// eight times what is usual around them, about as many to either side. Of shapes without noise and with Gaussian noise
/// hardly any are, of impulses of 0.2 edge lengths at one vertex in seven mostly 1 to 12 %. All other meshes are given
/// back as they are.
///
/// @param[out] highest  that impulses are at most, mesh units; 0: there are none
/// @returns  #V positions
/// Cost: linear; some 3,000 vertices are looked at, and only where there are impulses all of them, twice; parallel
Positions without_weak_impulses(const Faces& faces, const Positions& positions, const Incidence& at,
                                const Neighbours& near, double& highest);

/// Sets impulses beside creases back, which no quadric follows: off the plane of least absolute deviations by more than
/// eight times the median of what those around are; and those on creases to where two planes meet (to_crease()).
/// @param highest  see without_weak_impulses(), > 0
/// Cost: linear; parallel
Positions without_impulses_beside_creases(const Faces& faces, const Positions& positions, const Incidence& at,
                                          const Neighbours& near, double highest);

}  // namespace multires
