#pragma once

#include "mesh/rings.h"

namespace multires {

/// Copies rows of a table into a new one, renumbered: row r of the result is row from[r] of `rings`.
/// @param place  old number -> place, for entries and flaps
/// @param limit  flaps at places >= limit become none
/// @param flaps  with flaps: those of `rings`, or as find_flaps() gives them if it has none
Rings renumbered(const Rings& rings, const Array<Index>& from, const Array<Index>& place, Index limit, bool flaps);

/// The same into rows first, first + 1, ... of a table that has room for them, and for flaps if wanted, and their
/// offsets.
void renumber_into(Rings& out, Index first, const Rings& rings, const Array<Index>& from, const Array<Index>& place,
                   Index limit);

}  // namespace multires
