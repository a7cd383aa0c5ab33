#pragma once

#include "hierarchy/hierarchy.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

/// The update of lifting with the update first: before a vertex goes, its ring takes over its share of the mean
/// (Szczesna 2011, eq. 15).
namespace multires::ring_update {

/// What a vertex belongs to. A row moves vertices of its own kind only, so that boundaries and creases are curves of
/// their own, as in prediction.
enum class Part : std::uint8_t {
    surface,
    curve,  ///< the boundary or a crease
    fixed,  ///< corners, and vertices that have no ring: nothing moves them, and they move nothing
};

/// #V, by place.
Array<Part> parts_of(const Hierarchy& h);

/// Odd rows of a level, counted from its first, ordered and cut so that those of a batch can be updated and predicted
/// in any order or at the same time: no row of it writes what another one reads. Analysis goes from the last batch to
/// the first, synthesis from the first to the last; that is one vertex after the other, in an order of our choice
/// within each of the level's sets.
struct Batches {
    Array<Index> rows;          ///< #odd rows of the level; or empty: in their own order
    std::vector<Index> bounds;  ///< from 0 to #odd rows of the level

    Index row(Index at) const { return rows.empty() ? at : rows[at]; }
};

/// Cost: linear in the entries; one thread.
Batches batches_of(const Hierarchy& h, std::size_t level);
/// The sets themselves, for rows that write nothing but their own vertex.
Batches sets_of(const Level& level);

/// What the update of a row is about: the ring, or on curves the two neighbours along it.
struct Neighbours {
    Neighbours(const Rings& rings, Index row, const Array<Part>& part)
        : vertex(rings.begin(row)), size(rings.size(row)), own(part[rings.vertex(row)]) {
        if (own == Part::curve) {
            ends = along_curve(rings, row);
            vertex = ends.data(), size = 2;
        }
        for (Index j = 0; j < size && own != Part::fixed; ++j) moving += part[vertex[j]] == own;
    }
    Neighbours(const Neighbours&) = delete;
    Neighbours& operator=(const Neighbours&) = delete;

    const Index* vertex;
    Index size, moving = 0;
    Part own;

private:
    /// The ends of an open ring, or the two feature spokes of a closed one.
    static std::array<Index, 2> along_curve(const Rings& rings, Index row) {
        const Index* const ring = rings.begin(row);
        const Index last = rings.size(row) - 1;
        if (rings.kind[row] == RingKind::open) return {ring[0], ring[last]};
        const std::uint8_t* const feature = rings.feature.data() + rings.offset[row];
        Index a = 0, b = last;
        while (!feature[a]) ++a;
        while (!feature[b]) --b;
        return {ring[a], ring[b]};
    }

    std::array<Index, 2> ends{};
};

/// The m neighbours' mean moves by U = (v - mean) / (m + 1), so that it becomes the mean of all m + 1: neighbours of
/// the row's kind, k of them, move by m U / k each. Undone from v and the moved mean: U = (v - mean) / m. Nothing
/// happens where none may move.
/// @param at  double* at(Index place): `width` channels
template <class At>
void update(const Rings& rings, Index row, const Array<Part>& part, int width, bool undo, const At& at) {
    const Neighbours ring(rings, row, part);
    if (ring.moving == 0) return;
    const double factor = undo ? 1.0 / (ring.size * ring.moving) : -1.0 / ((ring.size + 1) * ring.moving);
    const double* const v = at(rings.vertex(row));
    for (int c = 0; c < width; ++c) {
        double sum = 0;
        for (Index j = 0; j < ring.size; ++j) sum += at(ring.vertex[j])[c] - v[c];
        const double move = factor * sum;
        for (Index j = 0; j < ring.size; ++j)
            if (ring.moving == ring.size || part[ring.vertex[j]] == ring.own) at(ring.vertex[j])[c] += move;
    }
}

}  // namespace multires::ring_update
