#pragma once

#include "denoise/neighbours.h"

namespace multires {

/// Values at single vertices that have nothing to do with those around them: dropouts, salt and pepper.
struct ValueImpulses {
    std::vector<double> values;         ///< #V by width, with the impulses replaced
    std::vector<std::uint8_t> impulse;  ///< #V: 1 where a value was replaced
    std::size_t count = 0;              ///< of these
};

/// Finds impulses by rank-ordered differences (Garnett et al. 2005): all neighbours of an impulse but one at most
/// differ from it by much more than they differ from each other, and than neighbours around it do. Lines one vertex
/// wide have two neighbours alike, so they stay. Replaced by the median of the neighbours that are none. Few hits are
/// taken for spots, and so are hits where the surface bends more than elsewhere, as extremes of a curvature: nothing is
/// changed.
/// @param bend    #V: how much the surface bends, >= 0, in any unit
/// @param values  #V by width
/// Cost: O(entries log valence)
ValueImpulses without_impulses(const Neighbours& near, const std::vector<double>& bend,
                               const std::vector<double>& values, int width);

}  // namespace multires
