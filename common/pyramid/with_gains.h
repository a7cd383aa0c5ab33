#pragma once

#include "pyramid/pyramid.h"

namespace multires {

/// Any field on the layer of a pyramid with the details of each level multiplied by a gain.
/// @param field  #V rows in order of the input
/// @param gain   of each level, finest first
/// @returns  the same. Cost: linear.
Field with_gains(const Pyramid& pyramid, const Field& field, const std::vector<double>& gain);

}  // namespace multires
