#pragma once

#include "filters/shape/denoise.h"

namespace multires {

/// Thresholding of detail vectors over the levels chosen, averaged over hierarchies (DenoiseOptions::cycle_spins).
/// @param given       threshold in mesh units, unless automatic
/// @param deviation   of the noise, mesh units, for the automatic threshold
/// @param confidence  #V or empty: each detail's threshold is scaled by 1 - confidence of its vertex
/// @returns  #V positions
Positions by_threshold(const Layer& layer, const DenoiseOptions& options, double given, double deviation,
                       const std::vector<double>& confidence, Session& session, Report& report);

}  // namespace multires
