#pragma once

#include <algorithm>
#include <vector>

namespace multires {

/// Whether all rows of values, of `width` > 0 numbers each, are the same; true without rows.
inline bool rows_are_equal(const std::vector<double>& values, int width) {
    return values.empty() || std::equal(values.begin() + width, values.end(), values.begin());
}

}  // namespace multires
