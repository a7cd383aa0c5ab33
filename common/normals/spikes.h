#pragma once

#include "normals/face_graph.h"

namespace multires {

/// Takes out impulsive noise: vertices that stand off the surface which the faces around their star make, far more than
/// all others nearby do.
///
/// A vertex is compared with the planes of the faces across its star's outer edges, of which it is no part: its offset
/// is the median of its distances from them. So the vertices of flat parts, creases, corners and cones have an offset
/// of 0, and few of the neighbours of a spike see it. A vertex is a spike if its offset is more than four times the
/// median one around it, more than 2.5 times the second largest of the same sign beside it, and more than 3 % of its
/// mean edge; it moves into the median plane. Vertices with less than four such faces, or where these do not agree,
/// stay.
///
/// Only a mesh where more than 3 % of the vertices are spikes is taken to have impulsive noise; all others are given
/// back as they are.
///
/// @param spikes  number of vertices that moved
/// @returns       #V positions
/// Cost: linear for bounded valences
Positions without_spikes(const Faces& faces, const Positions& positions, const Incidence& at, Index& spikes);

}  // namespace multires
