#pragma once

#include "filters/grid/grid_signal.h"
#include "filters/region.h"

/// Control meshes of triangular grids (Dreger, Gross and Schlegel, section 4, Figures 16 and 19).
namespace multires {

struct GridLevelOptions {
    GridOptions grid;        ///< positions are always all three
    int level = 1;           ///< 0 = the grid's own vertices; at most the number of levels
    int refine = 0;          ///< 0 to level + 3: steps of subdivision of the surface that these control points have
    bool attributes = true;  ///< colours, quality and custom ones are transformed like positions
};

/// The control points of a level as a new layer, or the surface they give at a finer level, even one finer than the
/// grid. At level 0 vertices and faces are the layer's own. A control mesh has points beyond the outline and in the
/// rims of holes. Attributes are transformed like positions, colours clamped; the others, and those with values that
/// are not finite, are taken from a vertex near.
/// @throws InputError  for a mesh that is no triangular grid, and a level it does not have
/// Cost: linear in the grid and the new layer.
Result generate_grid_level(const Layer& layer, const GridLevelOptions& options, Session& session);

struct GridEditOptions {
    LayerRef edited;          ///< a control mesh of the current layer as generate_grid_level() makes it, moved
    GridOptions grid;         ///< the one it was made with
    bool attributes = false;  ///< colours, quality and custom ones follow those of the control mesh, too
    Region region;
};

/// The surface follows its edited control mesh: every vertex moves by the sum of the control points' ways, each times
/// its function. Detail stays as it is. Which level it is, is told by the faces. An edit of which nothing is left in
/// single precision leaves every vertex exactly where it is. Attributes change by what those of the control points
/// differ from what generate_grid_level() gave them, each times its function.
/// @throws InputError  naming the layer if it is none of the control meshes
/// Cost: linear.
Result grid_edit(const Inputs& inputs, const GridEditOptions& options, Session& session);

}  // namespace multires
