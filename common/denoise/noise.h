#pragma once

#include "denoise/neighbours.h"

namespace multires {

/// White noise on a surface.
struct SurfaceNoise {
    double along_normals = 0;  ///< standard deviation of the part along the normals, mesh units
    /// Of the vertices' places within the surface in each of two directions, mesh units: an upper bound of the noise
    /// there, for an irregular sampling looks the same.
    double within_surface = 0;
};

/// Estimates the noise from third differences along smoothed normals. Their energies, averaged over a few rings, are
/// divided by those of white noise of deviation 1 pushed through the same operator on the same mesh, so that neither
/// the irregularity nor the valences matter. Noise is everywhere, texture and creases are not: so the lowest tenth of
/// the ratios counts, less what the spread from there to the third tenth says of texture.
///
/// Noise that is not the same everywhere is underestimated: its quietest part counts.
/// @param edge  mean edge length
/// Cost: linear, about 80 passes over the neighbours
SurfaceNoise surface_noise(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                           double edge);

}  // namespace multires
