#pragma once

#include "base/progress.h"
#include "mesh/mesh.h"

namespace multires {

/// A mesh wrapped onto another surface of about the same shape, and how close it came.
struct Wrapped {
    Positions positions;  ///< #V by 3
    double distance = 0;  ///< RMS distance of the vertices from the surface
};

/// Moves a mesh onto a surface by steps: every vertex wants to go to the point of the surface that is nearest to where
/// it is, and the displacement with the least  sum mass |u - wanted|^2 + length^2 (Dirichlet energy of u)  is taken.
/// The length falls from a quarter of the box to an edge, so that parts that were moved as a whole are met as a whole
/// first. What is nearer than its own thickness to another part of the surface, or turned by more than a right angle,
/// is not found again.
/// @param mesh            usable
/// @param faces, surface  at least one face; finite
/// Cost: 16 closest points a vertex and 16 solves. Same for any number of threads.
Wrapped wrap(const Mesh& mesh, const Faces& faces, const Positions& surface, const Progress& progress);

}  // namespace multires
