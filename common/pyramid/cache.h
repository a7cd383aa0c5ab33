#pragma once

#include "base/content_cache.h"
#include "pyramid/pyramid.h"

namespace multires {

/// The pyramids of one mesh that were used last: one for each set of options. Filters with other defaults thus find
/// theirs again when they are used in turn.
using PyramidCache = ContentCache<Pyramid>;

}  // namespace multires
