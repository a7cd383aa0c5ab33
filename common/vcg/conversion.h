#pragma once

/// Between any vcg triangle mesh type M and flat layers: vcg_*.h are the only headers of common/ that include vcglib.
/// M may keep its components in plain vectors or in vector_ocf ones (MeshLab's CMeshO), in float or double.
#include "vcg/derived.h"
#include "vcg/layer.h"
