#pragma once

#include "hierarchy/hierarchy.h"

namespace multires {

/// Removes one vertex after the other, always the cheapest (Guskov et al. 1999, section 3), and cuts the sequence into
/// levels of one vertex (level_ratio 0: rows only for the vertex and its ring) or of a share of the vertices.
/// Fills everything of the Hierarchy but the positions and counts.
Hierarchy sequential(const Rings& rings, const Positions& positions, const HierarchyOptions& options, const Tick& tick);

}  // namespace multires
