#pragma once

#include "filters/filter.h"

namespace multires {

/// "Compute pyramid": builds it and reports its levels.
struct ComputePyramidOptions {
    PyramidOptions pyramid;
};
Result compute_pyramid(const Layer& layer, const ComputePyramidOptions& options, Session& session);

/// "Generate level": the mesh of a level as a new layer.
struct GenerateLevelOptions {
    PyramidOptions pyramid;
    int level = 8;         ///< 0 = the input .. number of levels = the base; larger ones are an error
    bool at_most = false;  ///< take the last level instead of an error if there are not so many
    /// Positions of the coarse level of the pyramid (presmoothed) instead of the input's.
    bool smoothed = false;
};
Result generate_level(const Layer& layer, const GenerateLevelOptions& options, Session& session);

}  // namespace multires
