#include "schemes/ring_update.h"

#include "base/parallel.h"

namespace multires::ring_update {
namespace {

Part part_of(const Rings& rings, Index row) {
    const RingKind kind = rings.kind[row];
    if (kind != RingKind::closed && kind != RingKind::open) return Part::fixed;
    Index features = 0;
    if (!rings.feature.empty()) {
        // The ends of an open ring are along the boundary, marked or not.
        const Index inside = kind == RingKind::open ? 1 : 0;
        const auto begin = rings.feature.begin() + rings.offset[row] + inside;
        features = static_cast<Index>(std::count(begin, begin + (rings.size(row) - 2 * inside), std::uint8_t{1}));
    }
    if (kind == RingKind::open) return features == 0 ? Part::curve : Part::fixed;
    return features == 0 ? Part::surface : features == 2 ? Part::curve : Part::fixed;
}

constexpr int most = 64;  // colours

/// Gives every row of a set the first colour that no row it must not meet has; `most` if all are taken.
class Colouring {
public:
    Colouring(const Rings& odd, const Level& level)
        : odd_(odd), first_(level.odd.begin), masks_(level.fine), colour_(level.odd.size()) {}

    /// Rows as in Batches.
    void run(Index begin, Index end) {
        for (Index r = begin; r < end; ++r) {
            std::uint64_t taken = 0;
            for_ring(r, [&](Masks& m) { taken |= m.read; });
            for_flaps(r, [&](Masks& m) { taken |= m.written; });
            int colour = 0;
            while (colour < most && (taken >> colour & 1) != 0) ++colour;
            colour_[r] = static_cast<std::uint8_t>(colour);
            if (colour == most) continue;
            const std::uint64_t bit = std::uint64_t{1} << colour;
            for_ring(r, [&](Masks& m) { m.read |= bit, m.written |= bit; });
            for_flaps(r, [&](Masks& m) { m.read |= bit; });
        }
        for (Index r = begin; r < end; ++r) {
            for_ring(r, [](Masks& m) { m = Masks(); });
            for_flaps(r, [](Masks& m) { m = Masks(); });
        }
    }

    int of(Index row) const { return colour_[row]; }

private:
    struct Masks {
        std::uint64_t read = 0, written = 0;  ///< by rows of which colours
    };

    template <class Take>
    void for_ring(Index r, const Take& take) {
        r += first_;
        for (Index k = odd_.offset[r]; k < odd_.offset[r + 1]; ++k) take(masks_[odd_.neighbor[k]]);
    }
    template <class Take>
    void for_flaps(Index r, const Take& take) {
        if (odd_.flap.empty()) return;
        r += first_;
        for (Index k = odd_.offset[r]; k < odd_.offset[r + 1]; ++k) take(masks_[odd_.flap[k]]);
    }

    const Rings& odd_;
    Index first_;
    std::vector<Masks> masks_;
    Array<std::uint8_t> colour_;
};

}  // namespace

Array<Part> parts_of(const Hierarchy& h) {
    Array<Part> part(h.vertices());
    const auto take = [&](const Rings& rings, Index first) {
        parallel_for(rings.rows(), [&](Index r) { part[first + r] = part_of(rings, r); });
    };
    take(h.base, 0);
    take(h.odd, h.odd.first);
    return part;
}

Batches sets_of(const Level& level) {
    Batches out{{}, {0}};
    for (std::size_t s = 0; s < level.sets(); ++s) out.bounds.push_back(level.set(s).end - level.odd.begin);
    return out;
}

Batches batches_of(const Hierarchy& h, std::size_t k) {
    const Level& level = h.levels[k];
    const Index rows = level.odd.size();
    if (rows == 1) return {{}, {0, 1}};
    Batches out;
    out.rows.resize(rows);
    out.bounds = {0};
    Colouring colour(h.odd, level);
    for (std::size_t s = 0; s < level.sets(); ++s) {
        const Index begin = level.set(s).begin - level.odd.begin, end = level.set(s).end - level.odd.begin;
        colour.run(begin, end);
        std::array<Index, most + 2> at{};  // where the next row of each colour goes
        for (Index r = begin; r < end; ++r) ++at[colour.of(r) + 1];
        at[0] = begin;
        for (int c = 0; c <= most; ++c) {
            const Index count = at[c + 1];
            at[c + 1] += at[c];
            if (c < most && count > 0) out.bounds.push_back(at[c + 1]);
            if (c == most)
                for (Index one = 1; one <= count; ++one) out.bounds.push_back(at[c] + one);
        }
        for (Index r = begin; r < end; ++r) out.rows[at[colour.of(r)]++] = r;
    }
    return out;
}

}  // namespace multires::ring_update
