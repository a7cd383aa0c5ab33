#pragma once

#include "host/api.h"

#include "filters/filter.h"

#include <memory>

namespace multires::host {

/// What a mesh keeps between calls; either may be null.
struct Kept {
    std::shared_ptr<const KeptPyramid> pyramid;
    std::shared_ptr<const Original> original;
};

/// Where it keeps it: a named per-mesh attribute of vcg, which goes when the mesh goes and is not copied with it. It is
/// found by name, so it is common to all our plugins in a process, although each has its own copy of this code; the
/// name says which layout of KeptPyramid and Original it points to.
///
/// Hosts save it in no file. A VMI file from elsewhere may hold bytes under that name, as an attribute of another type:
/// they are never read, kept() gives nulls and slot() puts a new slot in their place.
///
/// The pyramid's code belongs to the plugin that built it, and hosts unload plugins before they delete meshes; our
/// plugins are therefore linked to stay loaded (-z nodelete).
Kept kept(const CMeshO& mesh);

/// The slot to keep it in, made if there is none. Assigning to it cannot fail.
/// @throws std::bad_alloc
Kept& slot(CMeshO& mesh);

}  // namespace multires::host
