#pragma once

#include "filters/filter.h"

namespace multires {

/// The smooth surface through some of a layer's vertices, with all of them and all its faces.
struct SmoothBaseOptions {
    int vertices = 1000;  ///< how many stay where they are, at most all; at least those of the pyramid's base do
    PyramidOptions pyramid;
};

/// The vertices of the mesh that half-edge collapses leave when `vertices` are left stay where they are; the others go
/// to where the bending energy, the integral of the squared Laplacian, is least (Vorsatz and Kobbelt, section 3: all
/// vertices are inserted again, and placed by a global minimisation). A new layer, with the same vertices in the same
/// order: to be edited and followed, or to take details from.
///
/// The Laplacian is that of the layer as it is. Vertices without faces, and those that no collapse removes, stay.
/// Reports how many stay, how far the others moved, and the steps of the solver.
/// @throws InputError  for meshes that are not usable and more vertices than there are
/// Cost: a pyramid, and 20 to 200 steps (at most 400) of conjugate gradients, linear each: fewer the more vertices
/// stay.
Result generate_base(const Layer& layer, const SmoothBaseOptions& options, Session& session);

}  // namespace multires
