#pragma once

#include "mesh/layer.h"

#include <string>

/// Where layers meet: their transformations place them in the document.
namespace multires {

/// The positions of a layer in the document.
/// @param which  names the layer in messages: "the other layer"
/// @throws InputError  if the transformation gives coordinates that are not finite
Positions in_world(const Layer& layer, const std::string& which);

/// Positions of the document in a layer's own coordinates.
/// @throws InputError  if the layer's transformation has no inverse
Positions from_world(Positions positions, const Layer& layer, const std::string& which);

/// The positions of `other` in the coordinates of `layer`; exactly its own if both have the same transformation.
/// @throws InputError  as above, naming `other` by `which`
Positions in_layer(const Layer& other, const Layer& layer, const std::string& which);

}  // namespace multires
