#pragma once

#include "filters/grid/grid_signal.h"

namespace multires {

/// A level of all grids of a layer as one mesh.
struct GridLevelMesh {
    DerivedMesh mesh;           ///< without positions
    std::vector<Field> values;  ///< of each field: #V' rows
};

/// Control points of a level, or the surface that they give at another one.
/// @param fields  #V rows each, in order of the input
/// @param faces   of the layer
/// @param shown   the level whose points the mesh has: `level` for the control mesh; less is finer, 0 the layer's own
///                vertices and faces, below 0 finer than the grid. Grids that have not as many levels give their last.
GridLevelMesh level_of(const FoundGrids& found, const std::vector<GridPyramid>& pyramids,
                       const std::vector<Field>& fields, const Faces& faces, int level, int shown);

/// The level whose control mesh has the faces of `edited`.
/// @throws InputError  naming `edited` if there is none
int matching_level(const FoundGrids& found, const std::vector<GridPyramid>& pyramids, const Mesh& layer,
                   const Mesh& edited, const Progress& progress);

/// Adds the ways of a level's control points to a field, each times its function.
/// @param way    rows of the control mesh of the level
/// @param after  #V rows
void follow(const FoundGrids& found, const std::vector<GridPyramid>& pyramids, const Faces& faces, int level,
            const Field& way, Field& after);

}  // namespace multires
