#pragma once

#include "base/disjoint_sets.h"
#include "hierarchy/hierarchy.h"

namespace multires {

/// The vertices in sets: those of one set are joined by edges.
/// Cost: about linear
inline DisjointSets parts_of(const Rings& rings) {
    DisjointSets parts(rings.rows());
    for (Index v = 0; v < rings.rows(); ++v)
        for (Index e = rings.offset[v]; e < rings.offset[v + 1]; ++e)
            if (rings.neighbor[e] > v || rings.size(rings.neighbor[e]) == 0)  // irregular: no row of its own
                parts.join(v, rings.neighbor[e]);
    return parts;
}

}  // namespace multires
