#pragma once

#include "grids/raster.h"

namespace multires {

/// Continues samples over holes and beyond the outline, so that filters near them have something to work on.
///
/// Points are reached in rings from the samples. One in ring k gets the mean, over the directions of the lattice in
/// which its neighbour a and the next one are known, of a + 0.9^k (slope to a): the mean slope over up to four points,
/// which goes on and dies away. Where there are none, it gets the mean of its known neighbours. Turns and mirrors of
/// the lattice turn the result.
/// @param mask  the samples, at least one; of the raster's size
/// @returns     the raster with `margin` more points on every side, all of them set
/// Cost: linear in the result.
Raster extended(const Raster& samples, const Mask& mask, Index margin);

}  // namespace multires
