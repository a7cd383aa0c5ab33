#pragma once

#include "mesh/rings.h"

namespace multires {

/// Copies rows of a table into a new one, renumbered: row r of the result is row from[r] of `rings`.
/// @param place  old number -> place, for entries and flaps
/// @param limit  flaps at places >= limit become none
Rings renumbered(const Rings& rings, const Array<Index>& from, const Array<Index>& place, Index limit);

/// Appends the rows of `more`; Rings::vertices is left alone.
void append(Rings& to, const Rings& more);

}  // namespace multires
