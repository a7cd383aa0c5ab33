#pragma once

#include "filters/filter.h"

namespace multires {

/// "Compute pyramid": builds it and reports its levels.
struct ComputePyramidOptions {
    PyramidOptions pyramid;
};
Result compute_pyramid(const Layer& layer, const ComputePyramidOptions& options, Session& session);

/// "Generate level": the mesh of a level as a new layer. Without a level, the one whose number of vertices is nearest
/// to a quarter of the mesh's, in the logarithm; if levels are so far apart that none has between a fifth and a third,
/// the mesh between two of them that comes nearest (a level goes set by set), unless positions are smoothed.
struct GenerateLevelOptions {
    PyramidOptions pyramid;
    std::optional<int> level;  ///< 0 = the input .. number of levels = the base; others are an error
    /// Positions of the coarse level of the pyramid (presmoothed) instead of the input's.
    bool smoothed = false;
};
Result generate_level(const Layer& layer, const GenerateLevelOptions& options, Session& session);

}  // namespace multires
