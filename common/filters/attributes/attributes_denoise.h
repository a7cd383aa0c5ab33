#pragma once

#include "filters/attributes/channels.h"
#include "filters/region.h"
#include "pyramid/pyramid.h"
#include "schemes/threshold.h"

namespace multires {

/// Denoising of attributes by thresholding the details of the pyramid (Roy et al. 2003, section 4.2): colours as
/// vectors of red, green and blue, and alpha by itself; custom points as vectors; everything else as scalars. Computed
/// in floating point throughout; the host rounds colours, once. The geometry stays as it is.
///
/// Automatic threshold. The standard deviation of the noise, sigma, is the median absolute deviation of the finest
/// level's details (of the subband where it is least) over 0.6745, divided by the gain g of that level: what the
/// scheme makes of white noise of deviation 1, which is measured (noise_gains). At a level of gain g_k noise then
/// has sigma_k = g_k sigma, and what the details vary by beyond that is signal, s_k^2 = max(0, var_k - sigma_k^2).
/// - soft: sigma_k^2 / s_k (Chang, Yu, Vetterli 2000, "BayesShrink"): all of a level that holds nothing but noise, next
///   to nothing of one that noise hardly reaches;
/// - hard: 3 sigma_k;
/// both times `strength`, and times the square root of the number of channels for vectors, which are that much longer.
/// A constant has no details and stays exactly as it is.
///
/// Levels that are small (one vertex each, say) share their statistics with their neighbours, until a quarter of the
/// vertices is reached.
struct AttributeDenoiseOptions {
    AttributeChoice what;  ///< attributes of vertices
    Shrink rule = Shrink::soft;
    bool automatic = true;
    double strength = 1;   ///< >= 0; factor for the automatic threshold
    double threshold = 0;  ///< >= 0, in units of the attribute (light or colour values: of 255), if not automatic
    int finest_level = 0;  ///< levels finest_level .. coarsest_level - 1 are denoised
    int coarsest_level = 1000000000;  ///< beyond the last: all of them
    /// Colours as amounts of light instead of the values as stored. Off, because noise in stored values has about the
    /// same size in dark and bright places, which one threshold asks for, and because it left less error wherever it
    /// was measured: of noise of 20 of 255 on a swirl, a terrain and a head 13.1, 14.0, 12.0; with it 14.4, 14.0, 13.7.
    bool linear_light = false;
    Region region;
    PyramidOptions pyramid = fine_levels();
};

/// Reports for each attribute: its noise (`label`_noise, in its units), and by group of levels, finest first, the
/// noise, the threshold and the share of details that became zero.
/// @throws InputError  for options out of range, attributes that are missing or not finite, and meshes that are not
///                     usable
/// Cost: building the pyramid, unless it is kept; then O(V) for each channel.
Result denoise_attributes(const Layer& layer, const AttributeDenoiseOptions& options, Session& session);

}  // namespace multires
