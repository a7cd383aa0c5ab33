#pragma once

#include "base/array.h"
#include "base/progress.h"
#include "mesh/mesh.h"
#include "solvers/conjugate_gradients.h"
#include "solvers/multigrid.h"
#include "solvers/stiffness.h"

#include <complex>
#include <cstdint>
#include <memory>
#include <vector>

namespace multires {

/// Values at vertices that somebody else owns: `width` interleaved channels, row-major.
struct ConstRows {
    const double* values = nullptr;
    Index rows = 0;
    int width = 0;

    ConstRows(const Positions& p)
        : values(p.empty() ? nullptr : p[0].data()), rows(static_cast<Index>(p.size())), width(3) {}
    ConstRows(const struct Rows& r);
    ConstRows(const Array<double>& v, int w) : values(v.data()), rows(static_cast<Index>(v.size() / w)), width(w) {}
};

/// The same, to be written.
struct Rows {
    double* values = nullptr;
    Index rows = 0;
    int width = 0;

    Rows(Positions& p) : values(p.empty() ? nullptr : p[0].data()), rows(static_cast<Index>(p.size())), width(3) {}
    Rows(Array<double>& v, int w) : values(v.data()), rows(static_cast<Index>(v.size() / w)), width(w) {}
};

inline ConstRows::ConstRows(const Rows& r) : values(r.values), rows(r.rows), width(r.width) {}

struct SystemOptions {
    StiffnessOptions stiffness;
    std::vector<std::uint8_t> fixed;  ///< #V or empty: 1 for vertices whose values are given
    /// C M^-1 C takes the place of C everywhere: the bending energy, of least which surfaces are smooth across fixed
    /// vertices. Takes three times the memory, and 26, 70, 170 steps if every 4th, 20th, 200th is fixed.
    bool bending = false;
};

/// What a solve works in beside the V-cycle, for those that solve again and again: 120 bytes a vertex, up to 220 if
/// complex. Of any content; used by one solve at a time.
struct SolveMemory {
    Array<double> right, residual;
    GradientsMemory<float> gradients;
};

struct SolveOptions {
    double tolerance =
        1e-8;  ///< of |residual| / |residual of the first guess|, every channel or all together, in (0, 1)
    int most_steps = 1000;
    bool together = false;          ///< GradientsOptions::together, of up to four channels each
    double enough = 0;              ///< GradientsOptions::enough: root of the mean square of a step's change of x
    SolveMemory* memory = nullptr;  ///< null: memory of its own
};

/// One term of a rational filter.
struct Term {
    /// z, not 0, apart from the negative real axis, where the spectrum is: Re z >= -10 |Im z|.
    std::complex<double> pole = 1;
    std::complex<double> weight = 1;  ///< w
};

/// How a solve went.
struct Solved {
    int steps = 0;          ///< the most that a group of up to four channels took
    double residual = 0;    ///< |residual| / |residual of the first guess|, of the worst channel
    bool converged = true;  ///< false if most_steps, or rounding, came first
    Index floating = 0;     ///< components without mass and without a fixed vertex: the mean of the first guess is kept
    Index without_faces = 0;  ///< free vertices in no face that counts: these keep the first guess
};

/// Symmetric positive definite and complex symmetric systems on a mesh, for any mass and stiffness after one set-up.
///
///     const System solver(mesh);
///     Positions x = mesh.positions;
///     solver.low_pass(2 * pi / cutoff, mesh.positions, x);
///
/// Conjugate gradients, preconditioned by one V-cycle (Multigrid); below 300 vertices that is a direct solve by Eigen's
/// SimplicialLDLT (a dense LU if complex). The number of steps hardly depends on the number of vertices.
/// Set-up and a step are linear in #V. Memory: about 250 bytes a vertex, and up to 300 more while it solves.
/// The same bits for any number of threads. Several solves at the same time are allowed.
class System {
public:
    /// @throws InputError  if `fixed` has another size than the mesh
    explicit System(const Mesh& mesh, const SystemOptions& options = {}, const Progress& progress = {});

    /// (mass M + stiffness C) x = rhs at the free vertices.
    /// @param x  #V by width: the first guess, and the values of fixed vertices; then the solution
    /// @throws InputError  unless mass, stiffness >= 0 and one of them > 0, and all values are finite
    Solved solve(double mass, double stiffness, ConstRows rhs, Rows x, const SolveOptions& options = {},
                 const Progress& progress = {}) const;

    /// out = sum over the terms of Re w (z M + s C)^-1 M f: any rational low pass with s = 1 / k^2. Fixed vertices and
    /// those without faces get their f times the sum of Re w / z, and so do constants, exactly.
    /// @param f, out  #V by width, not the same
    /// Terms with Re z < 0 (those of the sharper filters) are preconditioned by the V-cycle of the pole that is as far
    /// from 0 on the imaginary axis: the quotient stays within an arc around 1 that ends at z / (i |z|), so a pole at
    /// 135 degrees takes about twice the steps of one at 90.
    /// @throws InputError  unless all poles are as said, s >= 0, and all values are finite
    Solved rational(const std::vector<Term>& terms, double s, ConstRows f, Rows out, const SolveOptions& options = {},
                    const Progress& progress = {}) const;

    /// The spline filter of order 2 (ISO 16610-22): out = Re (M + i C / k^2)^-1 M f = (M + C M^-1 C / k^4)^-1 M f, of
    /// gain 1 / (1 + (q / k)^4) for wave number q.
    /// @param wave_number  k = 2 pi / cutoff, > 0; the cutoff is the wavelength of which half is left
    Solved low_pass(double wave_number, ConstRows f, Rows out, const SolveOptions& options = {},
                    const Progress& progress = {}) const;

    /// M, and C or what takes its place (bending()).
    const Stiffness& matrices() const { return matrices_; }

private:
    Solved correct(const Shift& shift, std::complex<double> factor, bool singular, const Array<double>& residual,
                   Rows x, const SolveOptions& options, const Progress& progress) const;

    Stiffness matrices_;
    std::vector<std::uint8_t> fixed_;
    Array<std::uint8_t> active_;  ///< free vertices with faces
    double mass_scale_ = 1;       ///< makes the mean mass 1
    double unit_ = 1;             ///< what matrices_ is to be multiplied by to be the stiffness
    Index without_faces_ = 0;
    std::unique_ptr<const Multigrid> grid_;
};

}  // namespace multires
