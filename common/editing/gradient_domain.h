#pragma once

#include "base/progress.h"
#include "editing/proxy.h"

namespace multires {

struct GradientDomainOptions {
    /// How many times the gradients are averaged with those of the neighbours, half and half.
    int smoothing = 5;
    /// How firmly vertices are held to where their motion takes them, > 0; no unit: against weights of edges, which are
    /// about 0.6 each. Gradients rule up to a distance of a few edges, positions beyond.
    double hold = 2;
};

/// The fine mesh, moved so that the shape around each vertex is turned and stretched as the gradients say, and where it
/// is as the displacements say: the displacement u with the least
///
///     sum over edges c_ij |(u_i - u_j) - (G_i + G_j) (x_i - x_j) / 2|^2 + hold sum |u_i - displacement_i|^2
///
/// with cotangent weights c (a Poisson equation with a screen; Yu et al., "Mesh Editing with Poisson-Based Gradient
/// Field Manipulation", 2004). Vertices are pulled straight where their motions alone would fold the surface: at feet
/// that jump from one side of the proxy to another, or far from it.
///
/// A motion that is affine is given back exactly. Vertices whose displacement and smoothed gradient are zero stay where
/// they are, bit for bit; vertices without a face move by their displacement.
/// @param motion   of the vertices; its gradients are smoothed in place
/// @returns the displacement, #V by 3
/// Cost: linear, about 15 steps of conjugate gradients. Same for any number of threads.
Positions gradient_domain(const Mesh& fine, Motion& motion, const GradientDomainOptions& options,
                          const Progress& progress);

}  // namespace multires
