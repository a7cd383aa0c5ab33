#pragma once

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
    constexpr std::size_t chunk = 4096;
    const auto chunks = static_cast<std::ptrdiff_t>((count + chunk - 1) / chunk);
    std::vector<T> partial(chunks);
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t c = 0; c < chunks; ++c) {
        const std::size_t begin = static_cast<std::size_t>(c) * chunk;
        partial[c] = part(begin, std::min(begin + chunk, count));
    }
    T total{};
    for (const T& p : partial) total += p;
    return total;
}

}  // namespace multires
