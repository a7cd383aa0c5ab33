#pragma once

#include "mesh/layer.h"

#include <optional>

namespace multires {

/// True for a part that is a speck, as float beside raw scans: fewer than 100 vertices, and less than a hundredth of
/// those of the largest part. They are too small for a surface and noise to be told apart.
constexpr bool is_speck(Index vertices, Index largest) { return vertices < 100 && vertices < largest / 100; }

/// A layer without specks.
struct WithoutSpecks {
    Layer layer;       ///< all vertices, those of specks in no face; without wedges
    Index specks = 0;  ///< how many there were
};

/// @param layer  face indices in range
/// @returns      nothing if there are no specks
/// Cost: linear.
std::optional<WithoutSpecks> without_specks(const Layer& layer);

}  // namespace multires
