#pragma once

#include "host/api.h"
#include "host/kept_pyramid.h"

#include "mesh/vcg_conversion.h"

namespace multires::host {

/// The model's mesh as the filter wants it.
/// @throws InputError  for a broken mesh, see to_layer
VcgLayer read_layer(const plugin::Filter& filter, const MeshModel& model);

/// Writes `result`, computed from `flat`, into the document and keeps `to_keep` with the model's mesh: all of it, or
/// (if it throws) nothing. A new layer becomes the current one; it takes over from the model's all that build_derived
/// copies, the texture images, the transformation and the camera.
/// Selections, layers and what the result does not hold stay as they are.
void write_result(MeshDocument& document, MeshModel& model, const VcgLayer& flat, Result& result, const Kept& to_keep);

}  // namespace multires::host
