#include "hierarchy/renumber.h"

#include "base/parallel.h"
#include "base/reduce.h"
#include "mesh/adjacency.h"

#include <algorithm>

namespace multires {

Rings renumbered(const Rings& rings, const Array<Index>& from, const Array<Index>& place, Index limit, bool flaps) {
    const Index rows = static_cast<Index>(from.size());
    Rings out;
    out.kind.resize(rows);
    out.offset.resize(rows + 1);
    out.offset[0] = 0;
    parallel_for(rows, [&](Index r) { out.offset[r + 1] = rings.size(from[r]); });
    add_up(out.offset);
    out.neighbor.resize(out.offset[rows]);
    if (flaps) out.flap.resize(out.offset[rows]);
    if (!rings.feature.empty()) out.feature.resize(out.offset[rows]);
    renumber_into(out, 0, rings, from, place, limit);
    return out;
}

void renumber_into(Rings& out, Index first, const Rings& rings, const Array<Index>& from, const Array<Index>& place,
                   Index limit) {
    parallel_for(static_cast<Index>(from.size()), [&](Index i) {
        const Index source = rings.offset[from[i]], size = rings.size(from[i]), r = first + i, to = out.offset[r];
        out.kind[r] = rings.kind[from[i]];
        for (Index j = 0; j < size; ++j) out.neighbor[to + j] = place[rings.neighbor[source + j]];
        if (!rings.feature.empty()) std::copy_n(rings.feature.data() + source, size, out.feature.data() + to);
        if (out.flap.empty()) return;
        Index* const flaps = out.flap.data() + to;
        if (rings.flap.empty())
            find_flaps(rings, from[i], flaps);
        else
            std::copy_n(rings.flap.data() + source, size, flaps);
        for (Index j = 0; j < size; ++j) {
            Index flap = flaps[j];
            const bool along = out.kind[r] == RingKind::open && (j == 0 || j + 1 == size);
            if (along && place[flap] >= limit) flap = next_on_boundary(rings, rings.neighbor[source + j], flap);
            flaps[j] = place[flap] < limit ? place[flap] : out.neighbor[to + j];
        }
    });
}

}  // namespace multires
