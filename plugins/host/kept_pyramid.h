#pragma once

#include "host/api.h"

#include <memory>

namespace multires::host {

using PyramidPointer = std::shared_ptr<const KeptPyramid>;

/// The place where a mesh keeps its pyramid between calls: a named per-mesh attribute of vcg, which goes when the mesh
/// goes and is not copied with it. It is found by name, so it is common to all our plugins in a process,
/// although each has its own copy of this code; the name says which layout of KeptPyramid it points to.
///
/// Hosts save it in no file. A VMI file from elsewhere may hold bytes under that name, as an attribute of another type:
/// they are never read, kept_pyramid() gives null and pyramid_slot() puts a new slot in their place.
///
/// The pyramid's code belongs to the plugin that built it, and hosts unload plugins before they delete meshes; our
/// plugins are therefore linked to stay loaded (-z nodelete).
PyramidPointer kept_pyramid(const CMeshO& mesh);

/// The slot to keep a pyramid in, made if there is none. Assigning to it cannot fail.
/// @throws std::bad_alloc
PyramidPointer& pyramid_slot(CMeshO& mesh);

}  // namespace multires::host
