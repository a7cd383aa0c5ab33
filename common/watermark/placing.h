#pragma once

#include "mesh/mesh.h"

#include <Eigen/Geometry>

#include <cstddef>

namespace multires {

class SurfaceTree;

/// The rotation, scale and shift that lay a mesh onto another one that is the same shape but for small changes, or of
/// which it is a part.
///
/// Starts from where the mesh is, from its vertices if it has the same faces as the other, and from its centroid and
/// axes of inertia turned in all 24 ways; each start is improved by iterated closest points (Besl and McKay 1992) with
/// distances to planes (Chen and Medioni 1992), and the one that comes nearest wins; among equals the first. A part
/// that was moved as well may not be found.
/// @param mesh, onto  usable; @param tree  of `onto`
/// Cost: about 10^5 searches in the tree.
Eigen::Affine3d similarity_onto(const Mesh& mesh, const Mesh& onto, const SurfaceTree& tree);

/// How thoroughly a placement is improved.
struct Refinement {
    std::size_t vertices = 4000;  ///< of the mesh, evenly chosen
    int steps = 40;               ///< at most
};

/// Improves a placement that is nearly right.
/// @returns  the mean distance of the mesh's vertices that is left, in parts of the size of `onto`
double refine_placement(const Mesh& mesh, const Mesh& onto, const SurfaceTree& tree, Eigen::Affine3d& placement,
                        const Refinement& how = {});

}  // namespace multires
