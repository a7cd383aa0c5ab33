#pragma once

#include "filters/layers/levels.h"
#include "hierarchy/hierarchy.h"

#include <cstdint>
#include <vector>

namespace multires {

/// The distance of each vertex from the region of the options, in space, mesh units: 0 inside.
/// @throws InputError  naming the parameter, for no selection, a box without an inside, a radius or growth out of range
/// Cost: linear; of a selection, O(#V log #F).
std::vector<double> region_distance(const Layer& layer, const GenerateLevelOptions& options);

/// How coarse it gets outside a region.
struct Coarsening {
    Index count = 0;      ///< vertices of the level it gets as coarse as; or of the result
    bool exact = false;   ///< `count` is that of the result
    double growth = 0.2;  ///< edge length a distance
};

/// The places to keep: all with a distance of 0, fewer with distance, and all these depend on.
/// @param positions, distance  #V by input vertex
/// @returns  #V by place, closed (hierarchy/refinement.h)
/// @throws InputError  naming the parameter, if the region alone has more than the exact number of vertices
std::vector<std::uint8_t> level_of_region(const Hierarchy& hierarchy, const Positions& positions,
                                          const std::vector<double>& distance, const Coarsening& how);

}  // namespace multires
