#include "operators/row_sums.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

// GCC for Windows does not align vectors of 32 bytes on the stack (its bug 54412); other compilers have no such
// vectors.
#if defined(__GNUC__) && (defined(__x86_64__) || defined(__aarch64__)) && (defined(__clang__) || !defined(_WIN32))
#define MULTIRES_VECTORS
#pragma GCC diagnostic ignored "-Wpsabi"  // vectors are passed to functions that are always inlined
#endif

namespace multires {
namespace {

/// The ring's or the flaps' half of a table.
template <class Weight>
struct Half {
    const Index* vertex;
    const Weight* weight;
};

template <class Weight>
struct Table {
    const Index* offset;
    Index entries;  ///< of the whole table
    Half<Weight> half[2];
    int halves;
};

template <class Weight>
void sums_by_channel(const Table<Weight>& t, Index begin, Index end, const double* f, int width, double* out) {
    constexpr bool differences = sizeof(Weight) < sizeof(double);
    for (Index r = begin; r < end; ++r, out += width) {
        const Index first = t.offset[r], last = t.offset[r + 1];
        std::fill_n(out, width, 0.0);
        if (first == last) continue;
        const double* const base = f + static_cast<std::size_t>(t.half[0].vertex[first]) * width;
        for (int h = 0; h < t.halves; ++h)
            for (Index k = first; k < last; ++k) {
                const double* const v = f + static_cast<std::size_t>(t.half[h].vertex[k]) * width;
                const double w = t.half[h].weight[k];
                for (int c = 0; c < width; ++c) out[c] += w * (differences ? v[c] - base[c] : v[c]);
            }
        if (differences)
            for (int c = 0; c < width; ++c) out[c] += base[c];
    }
}

#ifdef MULTIRES_VECTORS

#define MULTIRES_INLINE inline __attribute__((always_inline))

using Four = double __attribute__((vector_size(32)));
// The attributes before the equals sign: after it, clang ignores the alignment.
using FourUnaligned __attribute__((vector_size(32), aligned(8), may_alias)) = double;
using Mask __attribute__((vector_size(32), may_alias)) = std::int64_t;

constexpr Index few = 8, least = 4;

/// Row n: 8 masks, all ones for the first n.
struct Masks {
    alignas(32) std::int64_t row[few + 1][few][4] = {};
    constexpr Masks() {
        for (Index n = 0; n <= few; ++n)
            for (Index k = 0; k < n; ++k)
                for (std::int64_t& channel : row[n][k]) channel = -1;
    }
};
constexpr Masks masks;

// What is read beyond a vertex's values or a row's entries is not used, so other threads may be writing it. The thread
// sanitizer cannot know: for it, exactly what is used is read.
#ifdef __SANITIZE_THREAD__
constexpr bool reads_beyond = false;
#else
constexpr bool reads_beyond = true;
#endif

template <int Width>
MULTIRES_INLINE Four load(const double* values) {
    if constexpr (reads_beyond) return *reinterpret_cast<const FourUnaligned*>(values);
    Four v{};
    std::memcpy(&v, values, Width * sizeof(double));
    return v;
}

/// Adds a half of a row. Rows of 4 to 8 entries, nearly all, take 8 steps: those beyond the row's end are masked. A
/// loop over 5, 6 or 7 entries is mispredicted at nearly every row, which costs more than the sums.
template <int Width, class Weight>
MULTIRES_INLINE Four add_half(Four sum, const Four base, const Half<Weight> half, Index first, Index size, bool room,
                              const double* f) {
    constexpr bool differences = sizeof(Weight) < sizeof(double);
    const Index* const vertex = half.vertex + first;
    const Weight* const weight = half.weight + first;
    const auto term = [&](Index k) __attribute__((always_inline)) {
        const std::size_t at = static_cast<std::uint32_t>(vertex[k]);
        const Four v = load<Width>(f + Width * at);
        return static_cast<double>(weight[k]) * (differences ? v - base : v);
    };
    if (reads_beyond && room && size >= least && size <= few) {
        const Mask* const mask = reinterpret_cast<const Mask*>(masks.row[size]);
        for (Index k = 0; k < least; ++k) sum += term(k);
        for (Index k = least; k < few; ++k) sum += (Four)((Mask)term(k) & mask[k]);
    } else {
        for (Index k = 0; k < size; ++k) sum += term(k);
    }
    return sum;
}

template <int Width, int Halves, class Weight>
MULTIRES_INLINE void sums_by_four(const Table<Weight>& t, Index begin, Index end, const double* f, double* out) {
    constexpr bool differences = sizeof(Weight) < sizeof(double);
    // Fetched meanwhile, for processors do not see it coming in time: the values that are needed some 300 rows from
    // now, and the weights some 40 rows from now.
    constexpr Index values_ahead = 2048, weights_ahead = 256;
    for (Index r = begin; r < end; ++r, out += Width) {
        const Index first = t.offset[r], size = t.offset[r + 1] - first;
        if (t.entries - first > values_ahead)
            for (int h = 0; h < Halves; ++h) {
                const Half<Weight>& half = t.half[h];
                __builtin_prefetch(f + Width * static_cast<std::size_t>(half.vertex[first + values_ahead]));
                __builtin_prefetch(half.weight + first + weights_ahead);
            }
        Four sum{}, base{};
        if (differences && size > 0) base = load<Width>(f + Width * static_cast<std::size_t>(t.half[0].vertex[first]));
        const bool room = t.entries - first >= few;
        for (int h = 0; h < Halves; ++h) sum = add_half<Width>(sum, base, t.half[h], first, size, room, f);
        if (differences) sum += base;
        std::memcpy(out, &sum, Width * sizeof(double));
    }
}

#ifdef __x86_64__

template <int Width, int Halves, class Weight>
__attribute__((target("avx2"))) void sums_with_avx2(const Table<Weight>& t, Index begin, Index end, const double* f,
                                                    double* out) {
    sums_by_four<Width, Halves>(t, begin, end, f, out);
}

template <int Width, int Halves, class Weight>
void sums_by_width(const Table<Weight>& t, Index begin, Index end, const double* f, double* out) {
    static const bool avx2 = __builtin_cpu_supports("avx2");
    if (avx2)
        sums_with_avx2<Width, Halves>(t, begin, end, f, out);
    else
        sums_by_four<Width, Halves>(t, begin, end, f, out);
}

#else  // two NEON registers for one vector

template <int Width, int Halves, class Weight>
void sums_by_width(const Table<Weight>& t, Index begin, Index end, const double* f, double* out) {
    sums_by_four<Width, Halves>(t, begin, end, f, out);
}

#endif

template <int Width, class Weight>
void sums_by_width(const Table<Weight>& t, Index begin, Index end, const double* f, double* out) {
    if (t.halves == 1)
        sums_by_width<Width, 1>(t, begin, end, f, out);
    else
        sums_by_width<Width, 2>(t, begin, end, f, out);
}

#endif

template <class Weight>
void sums(const Table<Weight>& t, Index begin, Index end, const double* f, int width, double* out) {
#ifdef MULTIRES_VECTORS
    if (width == 3) return sums_by_width<3>(t, begin, end, f, out);
    if (width == 4) return sums_by_width<4>(t, begin, end, f, out);
#endif
    sums_by_channel(t, begin, end, f, width, out);
}

template <class Weight>
Table<Weight> table(const Rings& rings, const Weight* ring, const Weight* flap) {
    const Index entries = static_cast<Index>(rings.neighbor.size());
    return {rings.offset.data(), entries, {{rings.neighbor.data(), ring}, {rings.flap.data(), flap}}, flap ? 2 : 1};
}

}  // namespace

void row_sums(const RowWeights& rows, Index begin, Index end, const double* f, int width, double* out) {
    if (rows.ring_single)
        sums(table(*rows.rings, rows.ring_single, rows.flap_single), begin, end, f, width, out);
    else
        sums(table(*rows.rings, rows.ring, rows.flap), begin, end, f, width, out);
}

}  // namespace multires
