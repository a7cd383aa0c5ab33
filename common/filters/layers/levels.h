#pragma once

#include "filters/filter.h"

namespace multires {

/// "Compute pyramid": builds it and reports its levels.
struct ComputePyramidOptions {
    PyramidOptions pyramid;
};
Result compute_pyramid(const Layer& layer, const ComputePyramidOptions& options, Session& session);

/// Where the mesh of a level keeps all its detail.
enum class DetailIn {
    nowhere,  ///< the same level everywhere
    selection,
    box,
    sphere,
};

/// "Generate level": the mesh of a level as a new layer. Without a level, the one whose number of vertices is nearest
/// to a quarter of the mesh's, in the logarithm; if levels are so far apart that none has between a fifth and a third,
/// the mesh between two of them that comes nearest (a level goes set by set), unless positions are smoothed.
///
/// With a region, all vertices in it stay. Outside, edges may be longer than the input's by `growth` times the distance
/// from it, in space, until they are as long as the level's (or, with a number of vertices, as far as that goes). The
/// mesh is one of a closed set (hierarchy/refinement.h): all its faces come from collapses that were allowed.
struct GenerateLevelOptions {
    PyramidOptions pyramid;
    std::optional<int> level;  ///< 0 = the input .. number of levels = the base; others are an error
    int vertices = 0;          ///< > 0: so many, whatever the level; from the base's to the input's
    /// Positions of the coarse level of the pyramid (presmoothed) instead of the input's. Of whole levels only.
    bool smoothed = false;
    DetailIn detail_in = DetailIn::nowhere;
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< of the box
    Vec3 centre = Vec3::Zero();                    ///< of the sphere
    double radius = 1;                             ///< >= 0
    double growth = 0.2;                           ///< >= 0, edge length a distance
};
Result generate_level(const Layer& layer, const GenerateLevelOptions& options, Session& session);

}  // namespace multires
