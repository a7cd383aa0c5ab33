#include "hierarchy/refinement.h"

#include "base/radix_sort.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace multires {

Index Insertion::count(double threshold) const {
    const auto end =
        std::partition_point(order.begin(), order.end(), [&](Index place) { return key[place] >= threshold; });
    return static_cast<Index>(end - order.begin());
}

Insertion insertion_order(const Hierarchy& h, std::vector<double> importance) {
    Insertion out;
    out.key = std::move(importance);
    out.faces.assign(h.vertices(), 0);
    for (Index r = h.odd.rows() - 1; r >= 0; --r) {  // later places depend on earlier ones
        const double key = out.key[h.odd.vertex(r)];
        out.faces[h.odd.vertex(r)] = h.odd.kind[r] == RingKind::closed ? 2 : 1;
        const Index* const ring = h.odd.begin(r);
        for (Index j = 0; j < h.odd.size(r); ++j) out.key[ring[j]] = std::max(out.key[ring[j]], key);
    }
    const Index base = h.size.back();
    std::fill_n(out.key.begin(), base, std::numeric_limits<double>::infinity());
    Array<std::uint64_t> falling(h.vertices());
    std::transform(out.key.begin(), out.key.end(), falling.begin(), falling_radix_key);
    out.order.resize(h.vertices());
    std::iota(out.order.begin(), out.order.end(), 0);
    // Equal keys in order of places, which dependencies follow; so the base stays in front.
    out.order = sorted_by_key(std::move(out.order), falling);
    return out;
}

std::vector<std::uint8_t> inserted(const Insertion& insertion, Index count) {
    std::vector<std::uint8_t> in(insertion.order.size(), 0);
    for (Index i = 0; i < count; ++i) in[insertion.order[i]] = 1;
    return in;
}

LevelMesh mesh_of_set(const Hierarchy& h, const Faces& faces, const std::vector<std::uint8_t>& in) {
    return mesh_of_places(h, faces, places_left(h, [&](Index place) { return in[place] != 0; }));
}

}  // namespace multires
