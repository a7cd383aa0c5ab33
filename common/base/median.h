#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
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

/// The two values in the middle, the smaller first; of an odd number the one there is, twice.
/// @param values  at least one; reordered
/// Cost: linear on average.
template <class T>
std::pair<T, T> middle_values(std::vector<T>& values) {
    const T upper = upper_median(values);
    if (values.size() % 2 == 1) return {upper, upper};
    return {*std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2)), upper};
}

/// The value that a share (0 to 1) of the values does not exceed; of two neighbours the smaller.
/// @param values  at least one; reordered
/// Cost: linear on average.
template <class T>
T lower_quantile(std::vector<T>& values, double share) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

}  // namespace multires
