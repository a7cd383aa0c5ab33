#pragma once

#include "denoise/neighbours.h"

namespace multires {

/// How much the third differences along the normals are spread like those of Gaussian noise that is everywhere: 1 as
/// they are, less where few are large and many small, which is what texture, impulses, steps of quantisation and noise
/// of one side of the surface leave. Two ratios of quantiles of the differences, each divided by what the mesh makes of
/// it locally, over those of samples of noise on the same mesh; the smaller ratio counts, at most 1. Samples of noise
/// scatter by about 1 / sqrt(#V).
/// @param normal  #V by 3, of a smoothed surface
/// Cost: linear, about 25 passes over the neighbours
double whiteness(const Neighbours& near, const Positions& positions, const Array<Vec3>& normal);

}  // namespace multires
