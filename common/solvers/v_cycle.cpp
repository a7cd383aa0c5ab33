#include "solvers/multigrid.h"

#include "base/parallel.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include <type_traits>
#include <utility>

namespace multires {
namespace {

/// The part of the spectrum that the smoother damps: [largest / damped, largest].
constexpr double damped = 5;

/// The coarsest level has a few hundred rows, unless groups find no neighbours any more.
constexpr Index most_dense_rows = 1000;

using Level = Multigrid::Level;

/// L channels of one row; complex ones as L real and L imaginary parts. Inlined by force: that saves a third of the
/// time.
template <int L, bool Z>
struct RowOf {
    static constexpr int stride = Z ? 2 * L : L;
    using Type = Eigen::Array<float, stride, 1>;
    using Half = Eigen::Array<float, L, 1>;

    [[gnu::always_inline]] static Type get(const float* v, Index i) {
        return Eigen::Map<const Type>(v + static_cast<std::size_t>(i) * stride);
    }
    [[gnu::always_inline]] static Type get(const double* v, Index i) {
        return Eigen::Map<const Eigen::Array<double, stride, 1>>(v + static_cast<std::size_t>(i) * stride)
            .template cast<float>();
    }
    [[gnu::always_inline]] static void set(float* v, Index i, const Type& value) {
        Eigen::Map<Type>(v + static_cast<std::size_t>(i) * stride) = value;
    }
    using Factor = std::conditional_t<Z, std::complex<float>, float>;

    /// factor x value
    [[gnu::always_inline]] static Type times(float factor, const Type& value) { return factor * value; }
    [[gnu::always_inline]] static Type times(const std::complex<float>& factor, const Type& value) {
        if constexpr (Z) {
            Type out;
            out.template head<L>() =
                factor.real() * value.template head<L>() - factor.imag() * value.template tail<L>();
            out.template tail<L>() =
                factor.real() * value.template tail<L>() + factor.imag() * value.template head<L>();
            return out;
        } else {
            return factor.real() * value;
        }
    }
};

/// A on one row.
template <int L, bool Z>
[[gnu::always_inline]] inline typename RowOf<L, Z>::Type product(const Level& level, const std::complex<float>& z,
                                                                 float s, Index i, const float* x) {
    using Row = RowOf<L, Z>;
    using Type = typename Row::Type;
    const Type own = Row::get(x, i);
    Type c = level.stiffness_diagonal[i] * own, m = level.mass_diagonal[i] * own;
    if (level.mass.empty()) {
        for (Index k = level.offset[i]; k < level.offset[i + 1]; ++k)
            c += level.stiffness[k] * Row::get(x, level.column[k]);
    } else {
        for (Index k = level.offset[i]; k < level.offset[i + 1]; ++k) {
            const Type other = Row::get(x, level.column[k]);
            c += level.stiffness[k] * other;
            m += level.mass[k] * other;
        }
    }
    return s * c + Row::times(z, m);
}

/// Solves on the coarsest level.
template <bool Z>
class Coarsest {
public:
    using Scalar = std::conditional_t<Z, std::complex<double>, double>;
    /// Complex ones are dense: these are small, and Eigen's SparseLU crashes where memory runs out.
    using Matrix =
        std::conditional_t<Z, Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>, Eigen::SparseMatrix<Scalar>>;

    Coarsest(const Level& level, const std::complex<double>& z, double s) {
        const auto entry = [&](float m, float c) {
            if constexpr (Z) return z * static_cast<double>(m) + s * static_cast<double>(c);
            if constexpr (!Z) return z.real() * static_cast<double>(m) + s * static_cast<double>(c);
        };
        if constexpr (Z) {
            if (level.rows > most_dense_rows) return;  // what could not be grouped, next to nothing but a diagonal
            Matrix a = Matrix::Zero(level.rows, level.rows);
            for (Index i = 0; i < level.rows; ++i) {
                for (Index k = level.offset[i]; k < level.offset[i + 1]; ++k)
                    a(i, level.column[k]) = entry(level.mass.empty() ? 0.0F : level.mass[k], level.stiffness[k]);
                const Scalar diagonal = entry(level.mass_diagonal[i], level.stiffness_diagonal[i]);
                a(i, i) = diagonal == Scalar(0) ? Scalar(1) : diagonal;
            }
            factor_.compute(a);
            good_ = true;
        }
        if constexpr (!Z) {
            std::vector<Eigen::Triplet<Scalar>> entries;
            for (Index i = 0; i < level.rows; ++i) {
                const Scalar diagonal = entry(level.mass_diagonal[i], level.stiffness_diagonal[i]);
                entries.emplace_back(i, i, diagonal == Scalar(0) ? Scalar(1) : diagonal);
                for (Index k = level.offset[i]; k < level.offset[i + 1]; ++k)
                    entries.emplace_back(i, level.column[k],
                                         entry(level.mass.empty() ? 0.0F : level.mass[k], level.stiffness[k]));
            }
            Matrix a(level.rows, level.rows);
            a.setFromTriplets(entries.begin(), entries.end());
            factor_.compute(a);
            good_ = factor_.info() == Eigen::Success;
        }
    }
    bool good() const { return good_; }

    template <int L, class B>
    void solve(Index rows, const B* b, float* x) const {
        Eigen::Matrix<Scalar, Eigen::Dynamic, L> values(rows, L);
        constexpr int stride = Z ? 2 * L : L;
        for (Index i = 0; i < rows; ++i)
            for (int c = 0; c < L; ++c) {
                const B* const from = b + static_cast<std::size_t>(i) * stride;
                if constexpr (Z) values(i, c) = Scalar(from[c], from[L + c]);
                if constexpr (!Z) values(i, c) = from[c];
            }
        const Eigen::Matrix<Scalar, Eigen::Dynamic, L> solved = factor_.solve(values);
        for (Index i = 0; i < rows; ++i)
            for (int c = 0; c < L; ++c) {
                float* const to = x + static_cast<std::size_t>(i) * stride;
                if constexpr (Z) to[c] = static_cast<float>(solved(i, c).real());
                if constexpr (Z) to[L + c] = static_cast<float>(solved(i, c).imag());
                if constexpr (!Z) to[c] = static_cast<float>(solved(i, c));
            }
    }

private:
    std::conditional_t<Z, Eigen::PartialPivLU<Matrix>, Eigen::SimplicialLDLT<Matrix>> factor_;
    bool good_ = false;
};

}  // namespace

template <int L, bool Z>
struct VCycle<L, Z>::Work {
    using Row = RowOf<L, Z>;
    using Type = typename Row::Type;

    struct Vectors {
        Array<typename Row::Factor> inverse;  // of Jacobi's D; 0: the row takes no part
        Array<float> b, x, y;                 // x and b of the finest level are the caller's
        double largest = 2;
    };

    Work(const Multigrid& multigrid, const Shift& shift)
        : grid(multigrid.levels()), z(shift.mass), s(static_cast<float>(shift.stiffness)), at(grid.size()),
          coarsest(grid.back(), shift.mass, shift.stiffness) {
        for (std::size_t l = 0; l < grid.size(); ++l) {
            const Level& level = grid[l];
            at[l].inverse.resize(level.rows);
            parallel_for(level.rows, [&](Index i) {
                const typename Row::Factor d = mass() * level.mass_jacobi[i] + s * level.stiffness_jacobi[i];
                at[l].inverse[i] = d == 0.0F ? 0.0F : 1.0F / d;
            });
            at[l].largest = std::max(level.largest_mass, level.largest_stiffness);
            const std::size_t size = static_cast<std::size_t>(level.rows) * stride;
            if (l > 0) at[l].b.resize(size);
            if (l > 0) at[l].x.resize(size);
            if (l + 1 < grid.size()) at[l].y.resize(size);
        }
    }

    /// Two steps of Chebyshev's iteration for D^-1 A and the part [largest / damped, largest] of its spectrum: with d =
    /// first D^-1 (b - A x) as the first change, the second is keep d + second D^-1 (b - A (x + d)).
    struct Chebyshev {
        explicit Chebyshev(double largest) {
            const double low = largest / damped, theta = (largest + low) / 2, delta = (largest - low) / 2;
            const double sigma = theta / delta, rho = 1 / (2 * sigma - 1 / sigma);
            first = static_cast<float>(1 / theta);
            second = static_cast<float>(2 * rho / delta);
            keep = static_cast<float>(rho / sigma);
        }
        float first, second, keep;
    };

    /// D^-1 (b - A x) on one row.
    template <class B>
    [[gnu::always_inline]] Type correction(std::size_t l, Index i, float factor, const B* b, const float* x) const {
        return Row::times(factor * at[l].inverse[i], Row::get(b, i) - product<L, Z>(grid[l], z, s, i, x));
    }

    template <class B>
    void cycle(std::size_t l, const B* b, float* x) {
        const Level& level = grid[l];
        if (l + 1 == grid.size()) {
            if (coarsest.good()) {
                coarsest.template solve<L>(level.rows, b, x);
            } else {
                for (Index i = 0; i < level.rows; ++i) Row::set(x, i, Row::times(at[l].inverse[i], Row::get(b, i)));
            }
            return;
        }
        const Chebyshev step(at[l].largest);
        float* const y = at[l].y.data();
        // Two steps from 0; every pass writes another vector than the one it reads neighbours from.
        parallel_for(level.rows,
                     [&](Index i) { Row::set(y, i, Row::times(step.first * at[l].inverse[i], Row::get(b, i))); });
        parallel_for(level.rows, [&](Index i) {
            Row::set(x, i, (1 + step.keep) * Row::get(y, i) + correction(l, i, step.second, b, y));
        });
        parallel_for(level.rows, [&](Index i) { Row::set(y, i, Row::get(b, i) - product<L, Z>(level, z, s, i, x)); });
        const Level& coarse = grid[l + 1];
        Vectors& below = at[l + 1];
        parallel_for(coarse.rows, [&](Index i) {
            Type sum = Type::Zero();
            for (Index k = level.r_offset[i]; k < level.r_offset[i + 1]; ++k)
                sum += level.r[k] * Row::get(y, level.r_column[k]);
            Row::set(below.b.data(), i, sum);
        });
        cycle(l + 1, below.b.data(), below.x.data());
        parallel_for(level.rows, [&](Index i) {
            Type sum = Row::get(x, i);
            for (Index k = level.p_offset[i]; k < level.p_offset[i + 1]; ++k)
                sum += level.p[k] * Row::get(below.x.data(), level.p_column[k]);
            Row::set(x, i, sum);
        });
        parallel_for(level.rows, [&](Index i) { Row::set(y, i, Row::get(x, i) + correction(l, i, step.first, b, x)); });
        parallel_for(level.rows, [&](Index i) {
            const Type now = Row::get(y, i);
            Row::set(x, i, now + step.keep * (now - Row::get(x, i)) + correction(l, i, step.second, b, y));
        });
    }

    typename Row::Factor mass() const {
        if constexpr (Z) return z;
        if constexpr (!Z) return z.real();
    }

    const std::vector<Level>& grid;
    std::complex<float> z;
    float s;
    std::vector<Vectors> at;
    Coarsest<Z> coarsest;
};

template <int L, bool Z>
VCycle<L, Z>::VCycle(const Multigrid& grid, const Shift& shift) : work_(std::make_unique<Work>(grid, shift)) {}

template <int L, bool Z>
VCycle<L, Z>::~VCycle() = default;

template <int L, bool Z>
void VCycle<L, Z>::apply(const Array<double>& r, Array<float>& z) {
    work_->cycle(0, r.data(), z.data());
}

template class VCycle<1, false>;
template class VCycle<4, false>;
template class VCycle<1, true>;
template class VCycle<4, true>;

}  // namespace multires
