#pragma once

#include "denoise/neighbours.h"

namespace multires {

/// The step that smooth values were rounded to: all of them are multiples of it (from some value on), there are few
/// levels for the vertices, and values of neighbours are mostly on the same level and hardly ever more than one apart,
/// as on contour maps. Labels, which jump to any other, and signals as steep as the step are not taken for it.
/// @param values  #V, finite
/// @returns       0 if there is none
/// Cost: O(V log V)
double rounding_step(const Neighbours& near, const std::vector<double>& values);

/// A smooth function that rounding makes these values of: low passes (pairs of steps, see value_candidates.h) that do
/// not leave the interval of half a step around each value, in which the truth is.
/// @param values  #V
/// Cost: 60 passes over the neighbours
std::vector<double> within_steps(const Neighbours& near, const std::vector<double>& values, double step);

}  // namespace multires
