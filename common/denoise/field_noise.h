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

/// The same at each vertex, where the noise varies: measured in cells of several hundred vertices, then followed within
/// them by means of the third differences around each vertex, clipped. A cell has more than the others only if its
/// details are about white (first differences no larger than third ones, in units of noise); otherwise it is texture.
/// Where cells differ no more than by chance, or the mesh is too small for cells, it is field_noise() everywhere.
/// @returns  #V
std::vector<double> local_field_noise(const Neighbours& near, const std::vector<double>& weight,
                                      const Positions& positions, const std::vector<double>& values);

}  // namespace multires
