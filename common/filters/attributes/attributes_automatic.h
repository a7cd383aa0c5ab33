#pragma once

#include "denoise/values.h"
#include "filters/channels.h"

namespace multires {

/// One attribute denoised without a parameter (denoise/values.h): colours as vectors of red, green and blue, and alpha
/// by itself; custom points as vectors. What is no more than rounding of colours, half a step of 255, is no noise.
/// Reports, each with the attribute's label before it: _noise, _noise_least, _noise_most, _impulses, _rounding_step,
/// _estimated_rms_before, _estimated_rms_after, _share_low_pass, _share_wiener, _share_total_variation; and a line of
/// the log that says so in words. Of colours they are those of red, green and blue.
/// @param strength  >= 0; factor for the noise
/// @param tick      called with the fraction done; may throw to stop
Field denoised_automatically(const ValueSurface& surface, const Channels& channels, double strength, Report& report,
                             const std::function<void(double)>& tick);

}  // namespace multires
