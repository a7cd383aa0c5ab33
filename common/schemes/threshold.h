#pragma once

#include "schemes/scheme.h"

#include <algorithm>
#include <cmath>

/// Denoising by thresholding details (Donoho 1995; for vectors Roy et al. 2003, section 4.2).
namespace multires {

enum class Shrink {
    soft,  ///< d -> 0 if |d| <= t, else d - t d/|d| (Roy eq. 8)
    hard,  ///< d -> 0 if |d| <= t, else d
};

/// Shrinks one detail vector; t >= 0.
/// @returns true if it became 0
inline bool shrink(double* d, int width, double t, Shrink rule) {
    double square = 0;
    for (int c = 0; c < width; ++c) square += d[c] * d[c];
    const double length = std::sqrt(square);
    if (length <= t) {
        std::fill_n(d, width, 0.0);
        return true;
    }
    if (rule == Shrink::soft)
        for (int c = 0; c < width; ++c) d[c] *= 1 - t / length;
    return false;
}

/// How much white noise each subband takes up: standard deviation of one component of its details if every vertex
/// carries independent noise of standard deviation 1 in one channel. Measured by analysing such noise, so that it holds
/// for any scheme, operator and mesh; always the same random numbers. By level and subband, as in Coefficients.
using NoiseGains = std::vector<std::vector<double>>;
NoiseGains noise_gains(const Hierarchy& hierarchy, const Scheme& scheme);

/// Robust standard deviation of values around 0: median of |x| / 0.6745. Reorders the values; 0 if there are none.
double deviation_by_median(std::vector<double>& values);

}  // namespace multires
