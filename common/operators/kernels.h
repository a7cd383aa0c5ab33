#pragma once

#include "operators/star.h"

/// The operators on one closed star whose geometry is loaded; what relaxation.cpp is made of. Each writes #size weights
/// that sum to 1 and returns true, or returns false if nothing is left of the star (the weights are undefined then).
namespace multires::kernels {

/// Cotangent weights as they are (Roy 2003, eq. 2).
bool cotangent(const StarGeometry& star, double* weight);

/// Cotangents limited to [-largest, largest], negative sums to 0.
bool cotangent_clamped(const StarGeometry& star, double largest, double* weight);

/// Cotangent weights of the star with its non-Delaunay spokes flipped. Changes the star's dot, area, next, previous.
bool cotangent_delaunay(StarGeometry& star, double* weight);

/// What the second-order differences across link edges need.
struct Flaps {
    const Index* vertex;  ///< #size, as Rings::flap
    const Positions* positions;
    Vec3 center;  ///< position of the star's vertex
    double degenerate;
    double* weight;  ///< #size, written
};

/// Least squares of the second-order differences over the spokes that are no features (Guskov 1999, eq. 3), and over
/// the link edges too if flaps are given; all weights together sum to 1. Uses the star's scratch.
bool second_difference(StarGeometry& star, const std::uint8_t* feature, const Flaps* flaps, double* weight);

}  // namespace multires::kernels
