#pragma once

#include "schemes/threshold.h"

#include <vector>

namespace multires {

/// The threshold for noisy details of which the squared error is expected to be least (SureShrink, Donoho and Johnstone
/// 1995, section 2.4, with Stein's estimate for vectors and for both rules). With details d of `width` components,
/// noise of deviation s in each, and n of them,
///     soft   n width s^2 + sum min(|d|, t)^2 - 2 s^2 (sum over |d| <= t of width, over |d| > t of (width - 1) t / |d|)
///     hard   n width s^2 + sum over |d| <= t of |d|^2 - 2 s^2 (sum over |d| <= t of width, less t times the density of
///            the |d| at t), which jumps there
/// Noise may be correlated. Where nothing but noise is seen it is that under which pure noise stays, which is also the
/// largest. (Their test for that, section 2.5, is for a thousand values at most: it would drop weak shape here.)
/// @param lengths    |d|
/// @param deviation  s, >= 0; 0 gives 0
/// Cost: O(n log n)
double sure_threshold(std::vector<double> lengths, int width, double deviation, Shrink rule);

}  // namespace multires
