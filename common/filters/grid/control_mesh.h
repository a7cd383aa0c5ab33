#pragma once

#include "filters/grid/grid_signal.h"

namespace multires {

/// Points of the lattice at one level, with the faces between them.
struct ControlMesh {
    Array<std::size_t> place;  ///< #V: in the raster of the level
    std::vector<Vec3> at;      ///< #V: on the lattice of the grid, the third number is 0
    Array<Index> source;       ///< #V: the mesh's vertex near it
    Faces faces;
    Array<Index> source_face;  ///< #F: the mesh's face near it
};

/// The control points of a level, 1 or more: all that any face joins.
/// @param mesh  the faces of the mesh; the new ones have their orientation
ControlMesh control_mesh(const Grid& grid, const GridPyramid& pyramid, int level, const Faces& mesh);

/// The grid with each of its faces divided into 4^steps; `place` is in a raster of 2^steps (rows - 1) + 1 rows.
ControlMesh divided_grid(const Grid& grid, int steps, const Faces& mesh);

}  // namespace multires
