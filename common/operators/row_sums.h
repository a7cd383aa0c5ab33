#pragma once

#include "mesh/rings.h"

/// R f of many rows at once: what applying a relaxation spends its time on.
namespace multires {

/// Weights of some Rings' entries, and of their flaps unless `flap` is null: aligned with Rings::neighbor and
/// Rings::flap. Weights stored as float do not sum to 1; they multiply differences to the row's first value, where
/// they need not.
struct RowWeights {
    const Rings* rings = nullptr;
    const double* ring = nullptr;
    const double* flap = nullptr;
    const float* ring_single = nullptr;  ///< instead of `ring` and `flap`
    const float* flap_single = nullptr;
};

/// Rows begin..end-1: sum_k weight_k f_k, added up in the order of the entries, ring before flaps. Rows without entries
/// give 0. The same bits on all processors: wide ones do more channels at a time, not the sums in another order.
/// @param f      by vertex, `width` interleaved channels; part of an Array, for it may be read 32 bytes beyond its end
/// @param out    (end - begin) by width; not f
/// @param width  1 or more; 3 and 4 are fast
/// Cost: O(entries), on one thread.
void row_sums(const RowWeights& rows, Index begin, Index end, const double* f, int width, double* out);

}  // namespace multires
