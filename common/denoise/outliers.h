#pragma once

#include "denoise/neighbours.h"
#include "mesh/mesh.h"

namespace multires {

/// Puts back single vertices that lie far off an otherwise sound surface, the commonest error of scanners: too few of
/// them are no impulsive noise (normals/spikes.h).
///
/// A vertex is predicted without itself: the centre of its neighbours, half the way to the planes of the faces across
/// its star's outer edges. It is off by its distance from there, in units of the median distance of the neighbours from
/// their centre or of the mean edge of those faces, whichever is larger. It is an outlier if
/// - those planes agree, and with the vertex in the predicted place its star fits them;
/// - where it is, its star is steep or folded: vertices of skewed triangles are off, too, but within the surface;
/// - it has at most ten edges: cones on a plate, drawn as a fan, have more;
/// - it is off by more than two, and by far more than nearly all vertices are that are no outliers, nor beside
///   one: tips that the mesh has many of stay.
///
/// Neighbours that are far themselves, by their edges, count for nothing, so that two side by side are found. Where
/// more than 3 % of the vertices are such, it is another kind of noise, or the shape's: all stay.
///
/// @param[out] outliers  #V: 1 where a vertex moved
/// @returns    #V positions
/// Cost: linear for bounded valences
Positions without_outliers(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                           std::vector<std::uint8_t>& outliers);

}  // namespace multires
