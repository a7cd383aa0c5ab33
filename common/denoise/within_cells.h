#pragma once

#include "denoise/lattice.h"
#include "normals/face_graph.h"

namespace multires {

/// Terraces and ragged creases that are left of rounded coordinates are made smooth: bilateral steps of the normals of
/// the faces (Zheng, Fu, Au, Tai 2011), each followed by fitting vertices to them that stay in their cells, as long as
/// what is known of rounding allows it. The truth is off the rounded places by a variance of step^2 / 12 along the
/// normals, and so may the result be; and errors go first, so that each step adds less to that than the one before.
/// Where the second adds more, shape goes, and nothing is done.
/// @param machined  #F: 1 of faces of surfaces with creases; these and the others are asked one by one
/// @param graph     face_graph(faces, at)
/// @param rounded   the vertices as given
/// @param step      lattice_step(rounded)
/// @param share     of the way
/// Cost: up to five steps of the normals for either, with three of fitting each
void smooth_within_cells(const Faces& faces, const Incidence& at, const FaceGraph& graph,
                         const std::vector<std::uint8_t>& machined, const EvenPlaces& even, const Positions& rounded,
                         double step, double share, Positions& positions);

}  // namespace multires
