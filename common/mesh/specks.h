#pragma once

#include "mesh/layer.h"

#include <optional>

namespace multires {

/// A layer without specks: parts of fewer than 100 vertices that have less than a hundredth of those of the largest
/// part, as float beside raw scans. They are too small for a surface and noise to be told apart.
struct WithoutSpecks {
    Layer layer;       ///< all vertices, those of specks in no face; without wedges
    Index specks = 0;  ///< how many there were
};

/// @param layer  face indices in range
/// @returns      nothing if there are no specks
/// Cost: linear.
std::optional<WithoutSpecks> without_specks(const Layer& layer);

}  // namespace multires
