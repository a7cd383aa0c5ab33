#pragma once

#include "hierarchy/hierarchy.h"

#include <vector>

namespace multires {

/// One step of decimation: a maximal independent set of vertices collapsed at once. Vertices have local numbers,
/// kept in the order of the input.
struct Step {
    Rings rings;           ///< before the step
    Array<Index> code;     ///< number of an even vertex among the even ones, ~number of an odd one among the odd ones
    Array<Index> parent;   ///< of the odd vertices
    double mean_edge = 0;  ///< mean length of the rings' entries, of steps that begin a level
};

/// Decimates down to options.base_vertices; the last Step has no odd vertices and holds the base's rings.
std::vector<Step> independent_sets(Rings rings, Positions positions, const HierarchyOptions& options, const Tick& tick);

/// The same with vertices that move, down to options.base_vertices or to as few faces, whichever comes first; or to
/// where none of the cheapest share may be collapsed. Steps have no rings. See simplify().
/// @param positions  #V; becomes those of the vertices that stay, in their order
/// @param faces      how many there are
/// @param least      how many are wanted
std::vector<Step> moving_sets(Rings rings, Positions& positions, const HierarchyOptions& options, Index faces,
                              Index least, const Tick& tick);

}  // namespace multires
