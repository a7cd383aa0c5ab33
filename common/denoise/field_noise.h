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

/// The same at each vertex, where the noise varies: see NoiseByDifferences::varying(). Where it does not, or the mesh
/// is too small for cells, it is field_noise() everywhere.
/// @returns  #V
std::vector<double> local_field_noise(const Neighbours& near, const std::vector<double>& weight,
                                      const Positions& positions, const std::vector<double>& values);

/// Details of three fields: each vertex less the weighted mean of its neighbours.
/// @param h  #V by 3
std::vector<double> field_details(const Neighbours& near, const std::vector<double>& weight,
                                  const std::vector<double>& h);

}  // namespace multires
