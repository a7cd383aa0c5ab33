#pragma once

#include "denoise/smooth_regions.h"

namespace multires {

/// Mean square of the parts of the moves that lie within the surface where they lead to: where noise is along the
/// normals it is error that was made.
double moved_within(const Faces& faces, const Positions& from, const Positions& to);

/// Mean square error of the heights once vertices were moved into patches. These are the truth but for what the noise
/// makes of their terms, a variance each; so what vertices moved was error, and what is outside has the mean error at
/// least.
/// @param error     before
/// @param variance  of the noise along the normals
double error_after_patches(double error, double variance, const Faces& faces, const SmoothRegions& regions,
                           const Positions& before, const Positions& after);

/// Number of coordinates that planes along the axes hold, mean over the vertices. How far these planes were rounded
/// cannot be seen: each is an error of the rounding's variance before and after.
double mean_held(const EvenPlaces& even);

}  // namespace multires
