#pragma once

#include "base/array.h"
#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
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

/// Calls body(i, rank) for all i of [0, count), in parallel; the rank is how many elements before i there are that
/// counts(i) is true for. Both should be free of branches on what is hard to predict.
/// @param counts  bool(Index)
/// @returns       how many there are in all
template <class Counts, class Body>
Index ranked_for(Index count, const Counts& counts, const Body& body) {
    constexpr Index chunk = 4096;
    std::vector<Index> before((count + chunk - 1) / chunk + 1, 0);
    parallel_chunks(count, chunk, [&](Index begin, Index end) {
        Index sum = 0;
        for (Index i = begin; i < end; ++i) sum += counts(i);
        before[begin / chunk + 1] = sum;
    });
    std::partial_sum(before.begin(), before.end(), before.begin());
    parallel_chunks(count, chunk, [&](Index begin, Index end) {
        Index rank = before[begin / chunk];
        for (Index i = begin; i < end; ++i) {
            body(i, rank);
            rank += counts(i);
        }
    });
    return before.back();
}

/// Turns sizes into offsets: each element becomes the sum of those up to it. In parallel.
inline void add_up(Array<Index>& sizes) {
    constexpr Index chunk = 4096;
    const Index count = static_cast<Index>(sizes.size());
    std::vector<Index> before((count + chunk - 1) / chunk + 1, 0);
    parallel_chunks(count, chunk, [&](Index begin, Index end) {
        before[begin / chunk + 1] = std::accumulate(sizes.begin() + begin, sizes.begin() + end, Index{0});
    });
    std::partial_sum(before.begin(), before.end(), before.begin());
    parallel_chunks(count, chunk, [&](Index begin, Index end) {
        Index sum = before[begin / chunk];
        for (Index i = begin; i < end; ++i) sizes[i] = sum += sizes[i];
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
