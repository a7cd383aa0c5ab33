#include "solvers/multigrid.h"

#include "base/parallel.h"
#include "base/reduce.h"
#include "solvers/aggregation.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// Rows that are solved directly, also by a dense complex LU: of a small mesh, and of the coarsest level.
constexpr Index small = 300, coarsest = 120;

/// Level 0 from the mesh's matrices.
Multigrid::Level finest(const Stiffness& c, const Array<std::uint8_t>& active, double mass_scale) {
    Multigrid::Level level;
    const Index n = c.rows();
    level.rows = n;
    level.offset = c.offset;
    level.column = c.column;
    level.stiffness.resize(c.column.size());
    level.stiffness_diagonal.resize(n);
    level.mass_diagonal.resize(n);
    parallel_for(n, [&](Index i) {
        double sum = 0;
        for (Index k = c.offset[i]; k < c.offset[i + 1]; ++k) {
            sum += c.weight[k];
            level.stiffness[k] = active[i] && active[c.column[k]] ? -static_cast<float>(c.weight[k]) : 0;
        }
        level.stiffness_diagonal[i] = active[i] ? static_cast<float>(sum) : 0;
        level.mass_diagonal[i] = active[i] ? std::max(1e-6F, static_cast<float>(c.mass[i] * mass_scale)) : 0;
    });
    return level;
}

/// D of Jacobi: by Gershgorin, D^-1 A has no eigenvalue beyond 2.
void fill_jacobi(Multigrid::Level& level) {
    const auto fill = [&](const Array<float>& diagonal, const Array<float>& entry, Array<float>& jacobi) {
        jacobi.resize(level.rows);
        parallel_for(level.rows, [&](Index i) {
            double sum = std::abs(diagonal[i]);
            for (Index k = level.offset[i]; k < level.offset[i + 1] && !entry.empty(); ++k) sum += std::abs(entry[k]);
            jacobi[i] = std::max(diagonal[i], static_cast<float>(sum / 2));
        });
    };
    fill(level.stiffness_diagonal, level.stiffness, level.stiffness_jacobi);
    fill(level.mass_diagonal, level.mass, level.mass_jacobi);
}

/// A bound of the eigenvalues of D^-1 A that is nearer than 2, A = C or M: some steps of the power method from a fixed
/// vector.
float largest_eigenvalue(const Multigrid::Level& level, const Array<float>& entry, const Array<float>& diagonal,
                         const Array<float>& jacobi) {
    constexpr int steps = 8;
    constexpr double safety = 1.1;
    const Index n = level.rows;
    Array<float> x(n), y(n);
    const auto inverse = [&](Index i) { return jacobi[i] > 0 ? 1 / jacobi[i] : 0.0F; };
    parallel_for(n, [&](Index i) {
        std::uint32_t h = static_cast<std::uint32_t>(i) * 2654435761U;
        h ^= h >> 15, h *= 2246822519U, h ^= h >> 13;
        x[i] = inverse(i) > 0 ? static_cast<float>(h) / 4294967296.0F - 0.5F : 0;
    });
    double norm = 0, ratio = 2;
    for (int step = 0; step <= steps; ++step) {
        parallel_for(n, [&](Index i) {
            float sum = diagonal[i] * x[i];
            for (Index k = level.offset[i]; k < level.offset[i + 1]; ++k) sum += entry[k] * x[level.column[k]];
            y[i] = inverse(i) * sum;
        });
        const double next = std::sqrt(chunked_reduce<double>(n, [&](std::size_t begin, std::size_t end) {
            double sum = 0;
            for (std::size_t i = begin; i < end; ++i) sum += static_cast<double>(y[i]) * y[i] * jacobi[i];
            return sum;
        }));
        if (step > 0) ratio = norm > 0 ? next / norm : 2;
        norm = next;
        const float scale = next > 0 ? static_cast<float>(1 / next) : 0;
        norm = next > 0 ? 1 : 0;
        parallel_for(n, [&](Index i) { x[i] = y[i] * scale; });
    }
    return static_cast<float>(std::min(2.0, safety * ratio));
}

}  // namespace

Multigrid::Multigrid(const Stiffness& c, const Array<std::uint8_t>& active, double mass_scale,
                     const Progress& progress) {
    levels_.push_back(finest(c, active, mass_scale));
    for (;;) {
        Level& fine = levels_.back();
        fill_jacobi(fine);
        progress.report(1 - 1 / static_cast<double>(1 + levels_.size()), "Setting up the solver");
        if (fine.rows <= (levels_.size() == 1 ? small : coarsest) || levels_.size() > 30) return;
        fine.largest_stiffness =
            largest_eigenvalue(fine, fine.stiffness, fine.stiffness_diagonal, fine.stiffness_jacobi);
        if (!fine.mass.empty())
            fine.largest_mass = largest_eigenvalue(fine, fine.mass, fine.mass_diagonal, fine.mass_jacobi);
        const Groups groups = group_rows(fine);
        if (groups.count > 0.9 * fine.rows) return;
        make_prolongation(fine, groups);
        levels_.push_back(coarse_level(levels_.back(), groups.count));
    }
}

}  // namespace multires
