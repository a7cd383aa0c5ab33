#pragma once

#include "schemes/table.h"

#include <numeric>
#include <string>
#include <vector>

/// What tests that run on every scheme of the table share.
namespace multires::fixtures {

/// The numbers of all rows of schemes().
inline std::vector<int> every_scheme() {
    std::vector<int> all(schemes().size());
    std::iota(all.begin(), all.end(), 0);
    return all;
}

inline const Capabilities& can(int scheme) { return schemes()[static_cast<std::size_t>(scheme)].capabilities; }

/// A scheme's name as a part of a test's name.
inline std::string scheme_name(int scheme) { return schemes()[static_cast<std::size_t>(scheme)].name; }

}  // namespace multires::fixtures
