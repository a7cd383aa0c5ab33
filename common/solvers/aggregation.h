#pragma once

#include "solvers/multigrid.h"

/// The steps from one level of a Multigrid to the next.
namespace multires {

/// Groups of neighbouring rows.
struct Groups {
    Array<Index> of;  ///< #rows; -1: the row takes no part
    Index count = 0;
};

/// Greedy: a row none of whose strong neighbours is in a group yet makes a group with them; what is left joins the
/// neighbour it is tied to most strongly. Serial, linear.
Groups group_rows(const Multigrid::Level& level);

/// Fills p and r: constants on the groups, smoothed by one step of Jacobi, (I - w D^-1 C) T with w = 4 / (3 largest).
void make_prolongation(Multigrid::Level& level, const Groups& groups);

/// P' M P and P' C P.
Multigrid::Level coarse_level(const Multigrid::Level& fine, Index rows);

}  // namespace multires
