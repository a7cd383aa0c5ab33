#pragma once

#include "base/parallel.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace multires {

/// Folds part(begin, end) over [0, count) in parallel, in chunks of a fixed size that are joined in order: the result
/// is the same for any number of threads, to the last bit.
/// @param part  T(std::size_t begin, std::size_t end)
/// @param T     default-constructed it is the neutral element; T& += T joins
template <class T, class Part>
T chunked_reduce(std::size_t count, const Part& part) {
    constexpr Index chunk = 4096;
    std::vector<T> partial((count + chunk - 1) / chunk);
    parallel_chunks(static_cast<Index>(count), chunk, [&](Index begin, Index end) {
        partial[begin / chunk] = part(static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
    });
    T total{};
    for (const T& p : partial) total += p;
    return total;
}

}  // namespace multires
