#pragma once

#include "hierarchy/independent_sets.h"

namespace multires {

/// Moves the vertices that others were collapsed into, in one step of independent sets, to where they fit the faces
/// that were there best: the least area-weighted sum of squared distances to their planes, with the volume kept
/// (Lindstrom and Turk 1998, "Fast and Memory Efficient Polygonal Simplification", sections 4.1 and 4.2; their volumes
/// squared weight planes by squared areas). Vertices without a closed ring and on features stay. Offsets are halved,
/// and in the end given up, until no face is turned far or made much smaller by those of its corners.
/// @param before, old  rings and positions before the step
/// @param cosine       of the largest turn of a face's normal
/// @param after        rings after it
/// @param positions    of the vertices that stay, in their order; moved
void move_vertices(const Rings& before, const Positions& old, const Step& step, double cosine, const Rings& after,
                   Positions& positions);

}  // namespace multires
