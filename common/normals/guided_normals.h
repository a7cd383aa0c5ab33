#pragma once

#include "normals/face_graph.h"

#include <cstdint>

namespace multires {

/// Guided normals (Zhang, Deng, Zhang, Bouaziz, Liu 2015): each step filters the normals of the faces with weights that
/// fall with the difference not of the normals, but of guides, and fits the vertices to them. A face's guide is the
/// mean normal of the most consistent patch that holds it: a crease is not averaged over. Suits piecewise smooth
/// shapes; best begun where other noise than that at creases is gone.
///
/// Patches are a face and those it shares a vertex with, and a patch's consistency is measured from the normal of the
/// face in its middle, not over all its pairs as in the paper.
/// @param steps  see above; 8 steps of fitting each
/// @param moves  #V: vertices that are not to stay; empty: all
/// Cost: O(steps x entries of the graph)
Positions guided_steps(const Faces& faces, const Positions& positions, const Incidence& at, const FaceGraph& graph,
                       int steps, const std::vector<std::uint8_t>& moves = {});

}  // namespace multires
