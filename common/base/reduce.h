#pragma once

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
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

/// The same, one element at a time: add(T& part, std::size_t i) for all i in turn.
template <class T, class Add>
T chunked_fold(std::size_t count, const Add& add) {
    return chunked_reduce<T>(count, [&](std::size_t begin, std::size_t end) {
        T part{};
        for (std::size_t i = begin; i < end; ++i) add(part, i);
        return part;
    });
}

/// For folds: the mean of some values, 0 if there are none.
struct Mean {
    double sum = 0, weight = 0;

    void add(double value) { sum += value, ++weight; }
    Mean& operator+=(const Mean& o) {
        sum += o.sum, weight += o.weight;
        return *this;
    }
    double value() const { return weight > 0 ? sum / weight : 0; }
};

/// For folds: the largest and the root mean square of some lengths, given their squares.
struct Lengths {
    double largest_square = 0;
    Mean squares;

    void add(double square, double weight = 1) {
        largest_square = std::max(largest_square, square);
        squares += {weight * square, weight};
    }
    Lengths& operator+=(const Lengths& o) {
        largest_square = std::max(largest_square, o.largest_square);
        squares += o.squares;
        return *this;
    }
    double largest() const { return std::sqrt(largest_square); }
    double rms() const { return std::sqrt(squares.value()); }
};

}  // namespace multires
