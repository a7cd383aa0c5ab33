#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace multires {

/// The median; the larger of the two in the middle if there is an even number of values.
/// @param values  at least one; afterwards the half that is not larger comes first
/// Cost: linear on average.
template <class T>
T upper_median(std::vector<T>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace multires
