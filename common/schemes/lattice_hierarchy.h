#pragma once

#include "hierarchy/hierarchy.h"

namespace multires {

/// The hierarchy of triangular grids that halves the number of points along each direction from level to level: of the
/// four points (i, j) whose i / 2 and j / 2 are the same the first stays that is there, (0, 0), (1, 1), (1, 0) or
/// (0, 1), and the others go into it. So the mesh of a level is a grid again, and a level is an octave. Vertices in no
/// grid stay to the end.
///
/// Lattice places are filled in; rings are not (all rows are RingKind::isolated): nothing predicts vertices from them.
/// Of the options, base_vertices and seed count; a seed other than 0 shifts the grids by up to 7 points along each
/// direction, for another hierarchy.
/// @throws InputError  "scheme: ..." for a mesh that is no triangular grid, see find_grids()
/// Cost: linear.
Hierarchy lattice_hierarchy(const Mesh& mesh, const HierarchyOptions& options);

}  // namespace multires
