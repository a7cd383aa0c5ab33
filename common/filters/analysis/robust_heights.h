#pragma once

#include "bands/spline.h"

#include <vector>

namespace multires {

/// What of given heights a low pass at `coarsest` holds if it does not give way to what is cut or raised: robust
/// regression (after ISO 16610-71) on the side that the heights are skewed to. Four times, vertices that stand out on
/// that side, by more than part of the spread of all (Tukey's biweight, 3 standard deviations by the median), count
/// less, and the low pass is that of the weighted heights by that of the weights. How much vertices stand out is seen
/// after a low pass at 0.3 `coarsest`, for noise is not cut or raised.
/// @param spline  of the surface that the heights are over
/// @param height  #V, mesh units
/// @returns       #V, mesh units
/// Cost: six low passes of one or two channels. Same bits for any number of threads.
std::vector<double> robust_base(const Spline& spline, const std::vector<double>& height,
                                const std::vector<double>& area, LowPassOrder order, double coarsest,
                                const Progress& progress);

/// Skewness of values by their weights; 0 if all are alike.
double skewness_of(const std::vector<double>& values, const std::vector<double>& weight);

}  // namespace multires
