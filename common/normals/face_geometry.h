#pragma once

#include "normals/face_graph.h"

namespace multires {

/// Of all faces. Degenerate ones (area 0) have a zero normal.
struct FaceGeometry {
    Array<Vec3> normal;
    std::vector<double> area;
    Positions centroid;
};

FaceGeometry face_geometry(const Faces& faces, const Positions& positions);

/// Weights of the graph's entries: the neighbour's area times a Gaussian of the distance between the centroids.
/// @param reach  its deviation, in mean distances between the centroids of faces with a common edge
std::vector<double> spatial_weights(const FaceGraph& graph, const FaceGeometry& geometry, double reach);

}  // namespace multires
