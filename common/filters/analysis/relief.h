#pragma once

#include "bands/transmission.h"
#include "filters/filter.h"

#include <optional>

namespace multires {

struct ReliefOptions {
    std::optional<double> coarsest;  ///< mesh units, at least two mean edges; none: the band is chosen, see relief()
    double finest = 0;               ///< mesh units, < coarsest; 0: nothing is too fine, or chosen with the coarsest
    LowPassOrder order = LowPassOrder::second;  ///< tells letters from bumps better than the Gaussian
    bool robust = true;  ///< the low pass does not give way to what is cut or raised; false: it is linear, calibrated
    bool color = false;  ///< vertex colours, too: blue below, grey at 0, red above
};

/// Signed height over the low pass of the shape as vertex quality (analysis/heights.h), mesh units, positive on the
/// side the faces look to.
///
/// Without a band: what is cut or raised makes the distribution of heights lopsided, while form, furrows and noise lie
/// evenly about their mean. So the coarse limit is where, from four mean edges to a quarter of the box, heights
/// are most skewed, away from open rims (0.8 of that if the low pass is robust); and the fine limit lies an octave
/// below it: letters are told from the rest best where strokes are nearly as wide as what is smoothed. Colours reach
/// full strength at the height that a hundredth of the vertices pass.
/// @throws InputError  naming the parameter; see require_usable
/// Cost: four low passes and the set-up of a solver, six low passes of a scalar if robust; sixteen loose ones
/// (scale_space.h) to choose a band.
Result relief(const Layer& layer, const ReliefOptions& options, Session& session);

}  // namespace multires
