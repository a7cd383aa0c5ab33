#pragma once

#include "filters/shape/denoise.h"

namespace multires {

/// Denoising by estimated risk (denoise/automatic.h), with what it found and did in the report, as numbers and in
/// words.
/// @param given  deviation of the noise in mesh units, unless automatic
/// @returns      #V positions; the input's own where nothing is to be done
Positions by_automatic(const Layer& layer, const DenoiseOptions& options, double given, const Session& session,
                       Report& report);

}  // namespace multires
