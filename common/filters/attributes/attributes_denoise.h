#pragma once

#include "filters/channels.h"
#include "filters/region.h"
#include "pyramid/pyramid.h"
#include "schemes/threshold.h"

namespace multires {

enum class AttributeRule {  // the order is that of scripts: append
    soft,                   ///< thresholding: details up to the threshold go, the others become shorter by it
    hard,                   ///< the others stay
    automatic,              ///< chosen by estimated risk (denoise/values.h); soft where a threshold is given
};

/// Denoising of attributes: colours as vectors of red, green and blue, and alpha by itself; custom points as vectors;
/// everything else as scalars. Computed in floating point throughout; the host rounds colours, once. The geometry stays
/// as it is.
///
/// By default what is done has the least estimated risk, channel by channel, and no pyramid is made (see
/// attributes_automatic.h, denoise/values.h). The other rules threshold the details of the pyramid (Roy et al. 2003,
/// section 4.2).
///
/// Their automatic thresholds. The standard deviation of the noise is measured channel by channel
/// (denoise/field_noise.h), and what it makes of the details of each subband from white noise on the same mesh
/// (noise_gains). The threshold of a subband has the least estimated risk for its details (schemes/sure.h, SureShrink);
/// all of them are then scaled by the factor for which the values are expected to be nearest to the truth (Stein's
/// estimate with a random probe), and by `strength`. If none is expected to be clearly nearer than the input, or if
/// there is no noise (colours: less than half a step of 255, which is rounding), the values stay exactly as they are.
///
/// Levels that are small (one vertex each, say) share their statistics with their neighbours, until a quarter of the
/// vertices is reached.
struct AttributeDenoiseOptions {
    AttributeChoice what;  ///< attributes of vertices
    AttributeRule rule = AttributeRule::automatic;
    bool automatic = true;  ///< the noise is measured
    double strength = 1;    ///< >= 0; factor for the noise or the automatic threshold
    double threshold = 0;   ///< >= 0, in units of the attribute (light or colour values: of 255), if not automatic
    int finest_level = 0;   ///< levels finest_level .. coarsest_level - 1 are thresholded
    int coarsest_level = 1000000000;  ///< beyond the last: all of them
    /// Colours as amounts of light instead of the values as stored. Off, because noise in stored values has about the
    /// same size in dark and bright places, which one threshold asks for, and because it left less error wherever it
    /// was measured: of noise of 20 of 255 on a terrain and a head 12.1 and 12.0; with it 15.8 and 13.8. (Noise of
    /// saturated colours, half of it cut off, is left as it is.)
    bool linear_light = false;
    Region region;
    PyramidOptions pyramid = fine_levels();
};

/// Reports for each attribute what attributes_automatic.h says; or, with thresholds, its noise (`label`_noise, in its
/// units), and by group of levels, finest first, the noise, the threshold and the share of details that became zero.
/// @throws InputError  for options out of range, attributes that are missing or not finite, and meshes that are not
///                     usable
/// Cost: O(V) for each channel; with thresholds also building the pyramid, unless it is kept.
Result denoise_attributes(const Layer& layer, const AttributeDenoiseOptions& options, Session& session);

}  // namespace multires
