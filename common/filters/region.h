#pragma once

#include "filters/filter.h"

namespace multires {

/// Where a filter acts.
struct Region {
    bool selected = false;      ///< only on selected vertices and those of selected faces
    bool quality_mask = false;  ///< in the measure of the vertex quality: 0 not at all, 1 fully; clamped to [0, 1]
};

/// How much of the filter's effect each vertex gets, in [0, 1]; empty if all get all of it.
/// @throws InputError if nothing is selected, the mesh has no quality, or it holds NaN
std::vector<double> region_weights(const Layer& layer, const Region& region);

/// Moves `after` back towards `before` by weight; exactly to it where the weight is 0.
void blend(const Positions& before, const std::vector<double>& weights, Positions& after);

/// Adds to a report what moved: largest and RMS displacement, volume, area, flipped faces.
/// @throws InputError if `after` is not finite
void report_change(const Layer& layer, const Positions& after, Report& report);

}  // namespace multires
