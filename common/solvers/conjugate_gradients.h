#pragma once

#include "base/array.h"
#include "base/index.h"
#include "base/parallel.h"
#include "base/reduce.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <type_traits>

namespace multires {

struct GradientsOptions {
    double tolerance = 1e-8;  ///< of |residual| / |first residual|, every channel
    int most_steps = 200;
    /// The channels are parts of one vector: they share step lengths, so that turning them turns the solution, but for
    /// rounding, after any number of steps. They should have one unit. False: each has its own, and converges alone.
    bool together = false;
    /// Also converged is a step that changes the solution by no more than this, root of the mean over rows of what
    /// add() returned. What is left is about as much, if steps converge by half or better. 0: never.
    double enough = 0;
};

struct GradientsResult {
    int steps = 0;
    double residual = 0;  ///< |residual| / |first residual|, of the worst channel, as the recursion has it
    bool converged = true;
};

/// What conjugate_gradients() works in: two vectors of doubles and one of Number, as large as r. Given again it saves
/// the system the clearing of its pages, a tenth of a solve.
template <class Number>
struct GradientsMemory {
    Array<double> p, q;
    Array<Number> z;
};

namespace gradients_detail {

/// One number a channel.
template <int L, class Scalar>
struct Sums {
    std::array<Scalar, L> of{};
    Sums& operator+=(const Sums& other) {
        for (int c = 0; c < L; ++c) of[c] += other.of[c];
        return *this;
    }
    /// Every channel gets the sum of all.
    void join() {
        Scalar sum = 0;
        for (const Scalar& s : of) sum += s;
        of.fill(sum);
    }
};

template <int L>
struct Norms {
    Sums<L, double> residual;
    double change = 0;
    Norms& operator+=(const Norms& other) {
        residual += other.residual;
        change += other.change;
        return *this;
    }
};

/// The number of a row and channel.
template <int L, class Scalar, class Values>
Scalar number(const Values& v, std::size_t row, int channel) {
    if constexpr (std::is_same_v<Scalar, double>)
        return static_cast<double>(v[row * L + channel]);
    else
        return {static_cast<double>(v[row * 2 * L + channel]), static_cast<double>(v[row * 2 * L + L + channel])};
}

/// Without the checks for infinities of the standard's product.
inline double product(double a, double b) { return a * b; }
inline std::complex<double> product(const std::complex<double>& a, const std::complex<double>& b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// 0 where it is not finite.
template <class Scalar>
Scalar ratio(const Scalar& a, const Scalar& b) {
    const Scalar q = b == Scalar(0) ? Scalar(0) : a / b;
    return std::isfinite(std::abs(q)) ? q : Scalar(0);
}

}  // namespace gradients_detail

/// Preconditioned conjugate gradients (Hestenes and Stiefel 1952) for L independent right-hand sides at once, or, for
/// complex symmetric systems, conjugate orthogonal conjugate gradients (van der Vorst and Melissen 1990), which are the
/// same with products that are not conjugated. Solves A x = r for the change x of a first guess.
///
/// Vectors are arrays of rows; a row holds L real parts and, if Z, L imaginary parts after them.
/// @param apply         apply(p, q): q = A p, Array<double>
/// @param precondition  precondition(r, z): z = B r with B symmetric as A is; z is an Array<Number>
/// @param add           add(i, change): row i of the solution += L (2 L) numbers; returns the square of the change
/// @param r             the first residual; the last one afterwards
/// @param tick          tick(step, residual) once a step; may throw
/// @param memory        of any size and content
/// Same bits for any number of threads.
template <int L, bool Z, class Number, class Apply, class Precondition, class Add, class Tick>
GradientsResult conjugate_gradients(Array<double>& r, const GradientsOptions& options, const Apply& apply,
                                    const Precondition& precondition, const Add& add, const Tick& tick,
                                    GradientsMemory<Number>& memory) {
    using Scalar = std::conditional_t<Z, std::complex<double>, double>;
    using Dots = gradients_detail::Sums<L, Scalar>;
    using Norms = gradients_detail::Norms<L>;
    constexpr int stride = Z ? 2 * L : L;
    const std::size_t rows = r.size() / stride;
    const auto get = [](const auto& v, std::size_t i, int c) { return gradients_detail::number<L, Scalar>(v, i, c); };
    using gradients_detail::product, gradients_detail::ratio;
    const auto dot = [&](const auto& a, const auto& b) {
        Dots all = chunked_reduce<Dots>(rows, [&](std::size_t begin, std::size_t end) {
            Dots sum;
            for (std::size_t i = begin; i < end; ++i)
                for (int c = 0; c < L; ++c) sum.of[c] += product(get(a, i, c), get(b, i, c));
            return sum;
        });
        if (options.together) all.join();
        return all;
    };

    Norms first = chunked_reduce<Norms>(rows, [&](std::size_t begin, std::size_t end) {
        Norms sum;
        for (std::size_t i = begin; i < end; ++i)
            for (int c = 0; c < L; ++c) sum.residual.of[c] += std::norm(get(r, i, c));
        return sum;
    });
    if (options.together) first.residual.join();
    GradientsResult result;
    Array<double>&p = memory.p, &q = memory.q;
    Array<Number>& z = memory.z;
    p.resize(r.size()), q.resize(r.size()), z.resize(r.size());
    Dots rz;
    const auto worst = [&](const Norms& now) {
        double most = 0;
        for (int c = 0; c < L; ++c)
            if (first.residual.of[c] > 0) most = std::max(most, std::sqrt(now.residual.of[c] / first.residual.of[c]));
        return most;
    };
    result.residual = worst(first);
    for (; result.residual > options.tolerance && result.steps < options.most_steps; ++result.steps) {
        tick(result.steps, result.residual);
        precondition(r, z);
        const Dots next = dot(r, z);
        std::array<Scalar, L> factor;
        for (int c = 0; c < L; ++c) factor[c] = result.steps == 0 ? Scalar(0) : ratio(next.of[c], rz.of[c]);
        rz = next;
        const bool start = result.steps == 0;
        parallel_for(static_cast<Index>(rows), [&](Index i) {
            const std::size_t row = static_cast<std::size_t>(i);
            for (int c = 0; c < L; ++c) {
                const Scalar value = start ? get(z, row, c) : get(z, row, c) + product(factor[c], get(p, row, c));
                p[row * stride + c] = std::real(value);
                if constexpr (Z) p[row * stride + L + c] = std::imag(value);
            }
        });
        apply(p, q);
        const Dots pq = dot(p, q);
        for (int c = 0; c < L; ++c) factor[c] = ratio(rz.of[c], pq.of[c]);
        Norms now = chunked_reduce<Norms>(rows, [&](std::size_t begin, std::size_t end) {
            Norms sum;
            for (std::size_t i = begin; i < end; ++i) {
                std::array<double, stride> change;
                for (int c = 0; c < L; ++c) {
                    const Scalar step = product(factor[c], get(p, i, c));
                    const Scalar left = get(r, i, c) - product(factor[c], get(q, i, c));
                    change[c] = std::real(step);
                    r[i * stride + c] = std::real(left);
                    if constexpr (Z) change[L + c] = std::imag(step);
                    if constexpr (Z) r[i * stride + L + c] = std::imag(left);
                    sum.residual.of[c] += std::norm(left);
                }
                sum.change += add(static_cast<Index>(i), change.data());
            }
            return sum;
        });
        if (options.together) now.residual.join();
        const double before = result.residual;
        result.residual = worst(now);
        if (!std::isfinite(result.residual) || (result.residual == before && result.steps > 0)) break;
        if (options.enough > 0 && now.change <= options.enough * options.enough * static_cast<double>(rows)) {
            result.converged = true;
            ++result.steps;
            return result;
        }
    }
    result.converged = result.residual <= options.tolerance;
    return result;
}

}  // namespace multires
