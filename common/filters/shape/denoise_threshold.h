#pragma once

#include "filters/shape/denoise.h"

namespace multires {

/// Thresholding of detail vectors over the levels chosen, averaged over hierarchies (DenoiseOptions::cycle_spins).
///
/// The automatic thresholds are for Gaussian noise, which is measured: along the normals, and then only the parts of
/// the details along the normals are shrunk, because what is irregular within the surface is the sampling; or in all
/// directions, if it is found within the surface too. The pyramid is that of a smoothed surface, so that its weights
/// and its order do not depend on the noise, and the positions are functions on it. The thresholds of a subband have
/// the least estimated risk for its details (schemes/sure.h); all of them are then scaled by the factor for which the
/// surface itself is expected to be nearest to the truth, its differences along edges and its positions alike
/// (denoise_threshold_risk.h), and vertices go as far of the way there as gains even with the least noise there may be.
/// If none is expected to be clearly nearer than the input, it stays as it is.
/// Nor do they go farther than they come nearer to what automatic denoising makes of the mesh.
/// @param given       threshold in mesh units or percent of the details, unless automatic
/// @param confidence  #V or empty: each detail's threshold is scaled by 1 - confidence of its vertex
/// @returns  #V positions
Positions by_threshold(const Layer& layer, const DenoiseOptions& options, double given,
                       const std::vector<double>& confidence, Session& session, Report& report);

}  // namespace multires
