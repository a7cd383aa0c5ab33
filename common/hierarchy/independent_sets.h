#pragma once

#include "hierarchy/hierarchy.h"

#include <vector>

namespace multires {

/// One step of decimation: a maximal independent set of vertices collapsed at once. Vertices have local numbers,
/// kept in the order of the input.
struct Step {
    Rings rings;                ///< before the step
    std::vector<Index> parent;  ///< of an odd vertex; -1 for even ones
    std::vector<Index> rank;    ///< number of a vertex among the even ones, or among the odd ones
    Index odd = 0;              ///< how many are odd
};

/// Decimates down to options.base_vertices; the last Step has no odd vertices and holds the base's rings.
std::vector<Step> independent_sets(Rings rings, Positions positions, const HierarchyOptions& options, const Tick& tick);

}  // namespace multires
