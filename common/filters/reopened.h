#pragma once

#include "filters/across_seams.h"

namespace multires {

/// A new layer that was made of a closed one, as one of the layer itself, see across_seams(). Its vertices are in the
/// order of the input if they were, otherwise in that of `mesh`.
DerivedMesh reopened(const Layer& layer, const ClosedLayer& closed, DerivedMesh mesh);

}  // namespace multires
