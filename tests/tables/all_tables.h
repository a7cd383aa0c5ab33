#pragma once

#include "table.h"

#include <vector>

namespace multires::plugin {

/// The tables of all plugins in plugins/, in one program. Each plugin's sources are compiled once more for it, with
/// `table` renamed to `table_<plugin>`; the definition is written by tests/tables/CMakeLists.txt.
std::vector<const Plugin*> all_tables();

}  // namespace multires::plugin
