#pragma once

namespace multires::host {

/// Keeps the plugin that this is compiled into in memory until the process ends, whoever unloads it: what it left in a
/// mesh has its destructor there. On Linux the linker's option nodelete does that, and nothing is done here.
void stay_loaded();

}  // namespace multires::host
