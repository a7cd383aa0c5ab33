#pragma once

#include "base/array.h"
#include "base/progress.h"
#include "solvers/stiffness.h"

#include <complex>
#include <cstdint>
#include <memory>
#include <vector>

namespace multires {

/// Which system of a family z M + s C.
struct Shift {
    std::complex<double> mass = 1;  ///< z, Re z >= 0
    double stiffness = 1;           ///< s >= 0
    bool real() const { return mass.imag() == 0; }
};

/// A hierarchy of ever smaller matrices for z M + s C, by smoothed aggregation (Vanek, Mandel and Brezina 1996): rows
/// are grouped with their neighbours, constants on the groups are smoothed by one Jacobi step of C and make the
/// prolongation P, the coarse matrices are P' M P and P' C P. Nothing of this depends on z and s, so one hierarchy
/// serves all shifts; and it asks for no manifold, as half-edge collapses do.
///
/// Kept in single precision: it preconditions, conjugate gradients in double precision do the rest.
/// Memory: about 130 bytes a row. Cost: linear; same bits for any number of threads.
class Multigrid {
public:
    struct Level {
        Index rows = 0;
        Array<Index> offset, column;   ///< off-diagonal entries
        Array<float> stiffness, mass;  ///< aligned with column; mass is empty if M is diagonal
        Array<float> stiffness_diagonal, mass_diagonal;
        Array<float> stiffness_jacobi, mass_jacobi;     ///< no less than the diagonals, D: D^-1 A has eigenvalues <= 2
        float largest_stiffness = 2, largest_mass = 1;  ///< bounds of the eigenvalues of D^-1 C and D^-1 M
        /// Prolongation, rows by coarser rows, and its transpose; empty on the coarsest level.
        Array<Index> p_offset, p_column, r_offset, r_column;
        Array<float> p, r;
    };

    /// @param active  #V: rows that take part; the others have the value 0 (fixed vertices, vertices without a face)
    Multigrid(const Stiffness& c, const Array<std::uint8_t>& active, double mass_scale, const Progress& progress);

    const std::vector<Level>& levels() const { return levels_; }

private:
    std::vector<Level> levels_;
};

/// One V-cycle for a shift: z = B r with B symmetric (complex symmetric), B about (z M + s C)^-1. Linear but for
/// rounding.
/// @tparam L      channels solved at once, interleaved
/// @tparam Z      complex: L real parts, then L imaginary parts
template <int L, bool Z>
class VCycle {
public:
    static constexpr int stride = Z ? 2 * L : L;

    VCycle(const Multigrid& grid, const Shift& shift);
    ~VCycle();

    /// @param r  #V by stride
    /// @param z  #V by stride
    void apply(const Array<double>& r, Array<float>& z);

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

}  // namespace multires
