#include "hierarchy/renumber.h"

#include "base/parallel.h"
#include "mesh/adjacency.h"

#include <algorithm>

namespace multires {

Rings renumbered(const Rings& rings, const Array<Index>& from, const Array<Index>& place, Index limit) {
    const Index rows = static_cast<Index>(from.size());
    Rings out;
    out.kind.resize(rows);
    out.offset.resize(rows + 1);
    for (Index r = 0; r < rows; ++r) out.offset[r + 1] = out.offset[r] + rings.size(from[r]);
    out.neighbor.resize(out.offset[rows]);
    if (!rings.flap.empty()) out.flap.resize(out.offset[rows]);
    if (!rings.feature.empty()) out.feature.resize(out.offset[rows]);
    parallel_for(rows, [&](Index r) {
        out.kind[r] = rings.kind[from[r]];
        const Index source = rings.offset[from[r]], size = rings.size(from[r]), to = out.offset[r];
        for (Index j = 0; j < size; ++j) out.neighbor[to + j] = place[rings.neighbor[source + j]];
        if (!rings.feature.empty()) std::copy_n(rings.feature.data() + source, size, out.feature.data() + to);
        if (rings.flap.empty()) return;
        for (Index j = 0; j < size; ++j) {
            Index flap = rings.flap[source + j];
            const bool along = out.kind[r] == RingKind::open && (j == 0 || j + 1 == size);
            if (along && place[flap] >= limit) flap = next_on_boundary(rings, rings.neighbor[source + j], flap);
            out.flap[to + j] = place[flap] < limit ? place[flap] : out.neighbor[to + j];
        }
    });
    return out;
}

void append(Rings& to, const Rings& more) {
    const Index entries = to.offset.back();
    for (Index r = 0; r < more.rows(); ++r) to.offset.push_back(entries + more.offset[r + 1]);
    to.neighbor.insert(to.neighbor.end(), more.neighbor.begin(), more.neighbor.end());
    to.flap.insert(to.flap.end(), more.flap.begin(), more.flap.end());
    to.feature.insert(to.feature.end(), more.feature.begin(), more.feature.end());
    to.kind.insert(to.kind.end(), more.kind.begin(), more.kind.end());
}

}  // namespace multires
