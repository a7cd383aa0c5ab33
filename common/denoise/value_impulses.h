#pragma once

#include "denoise/values.h"

namespace multires {

/// Values at single vertices that have nothing to do with those around them: dropouts, salt and pepper.
struct ValueImpulses {
    std::vector<double> values;         ///< #V by width, with the impulses replaced
    std::vector<std::uint8_t> impulse;  ///< #V: 1 where a value was replaced
    std::size_t count = 0;              ///< of these
};

/// Finds impulses by rank-ordered differences (Garnett et al. 2005), of values less what they rise around the vertex
/// (value_slopes.h): all neighbours of an impulse but one at most differ from it by much more than they differ from
/// each other, and than neighbours around it do. Lines one vertex wide have two neighbours alike, so they stay.
/// Replaced by the median of the neighbours that are none, as they would be seen here. Few hits are taken for spots,
/// and so are hits where the surface bends more, or its vertices have other numbers of neighbours, than elsewhere, as
/// extremes of a curvature or numbers of faces: nothing is changed.
/// @param values  #V by width, width at most 4
/// Cost: O(entries log valence), and value_slopes() up to four times
ValueImpulses without_impulses(const ValueSurface& surface, const std::vector<double>& values, int width);

}  // namespace multires
