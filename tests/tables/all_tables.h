#pragma once

#include "shared/table.h"

#include <vector>

namespace multires::plugin {

/// The tables of all plugins in plugins/, in one program. Each plugin's sources are compiled once more for it, with
/// `table` renamed to `table_<plugin>`; the definition is written by tests/tables/CMakeLists.txt.
std::vector<const Plugin*> all_tables();

/// Every filter of every plugin.
inline std::vector<const Filter*> all_filters() {
    std::vector<const Filter*> all;
    for (const Plugin* plugin : all_tables())
        for (const Filter& filter : plugin->filters) all.push_back(&filter);
    return all;
}

}  // namespace multires::plugin
