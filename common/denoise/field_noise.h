#pragma once

#include "denoise/neighbours.h"

namespace multires {

/// Standard deviation of white noise in values on a surface, from differences of first and third order along the edges.
/// They are compared with those of samples of noise on the same mesh: the quieter third of the vertices gives the
/// deviation, because edges and textured places only add to it; what first differences have more is shape, of which a
/// share is taken off; and no more is believed than the distribution of the third differences allows, which is not that
/// of noise where texture is everywhere or values are rounded.
/// @param weight  #entries, rows that sum to 1: cotangent_weights() of the surface
/// @param values  #V
/// Cost: linear, about 50 passes over the neighbours
double field_noise(const Neighbours& near, const std::vector<double>& weight, const std::vector<double>& values);

}  // namespace multires
