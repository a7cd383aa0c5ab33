#include "editing/gradient_domain.h"

#include "base/parallel.h"
#include "base/reduce.h"
#include "solvers/conjugate_gradients.h"
#include "solvers/stiffness.h"

#include <algorithm>
#include <utility>

namespace multires {
namespace {

void smooth_gradients(const Stiffness& c, int steps, Array<Mat3>& gradient, const Progress& progress) {
    Array<Mat3> next(gradient.size());
    for (int step = 0; step < steps; ++step) {
        progress.report(static_cast<double>(step) / steps, "Smoothing the motion");
        parallel_for(c.rows(), [&](Index i) {
            const Index begin = c.offset[i], end = c.offset[i + 1];
            next[i] = gradient[i];
            if (begin == end) return;
            Mat3 sum = Mat3::Zero();
            for (Index k = begin; k < end; ++k) sum += gradient[c.column[k]];
            next[i] = 0.5 * (gradient[i] + sum / (end - begin));
        });
        std::swap(gradient, next);
    }
}

/// The system: C + hold, at the vertices that move.
class Screened {
public:
    Screened(const Stiffness& c, double hold, const Motion& motion) : c_(c), hold_(hold), inverse_(c.rows()) {
        parallel_for(c.rows(), [&](Index i) {
            double diagonal = hold;
            for (Index k = c.offset[i]; k < c.offset[i + 1]; ++k) diagonal += std::abs(c.weight[k]);
            const bool still = motion.displacement[i] == Vec3::Zero() && motion.gradient[i] == Mat3::Zero();
            inverse_[i] = still ? 0 : 1 / diagonal;
        });
    }

    bool moves(Index i) const { return inverse_[i] > 0; }

    /// out = (C + hold) p
    void apply(const Array<double>& p, Array<double>& out) const {
        parallel_for(c_.rows(), [&](Index i) {
            double* q = &out[3 * static_cast<std::size_t>(i)];
            q[0] = q[1] = q[2] = 0;
            if (!moves(i)) return;
            const double* at = &p[3 * static_cast<std::size_t>(i)];
            for (int d = 0; d < 3; ++d) q[d] = hold_ * at[d];
            for (Index k = c_.offset[i]; k < c_.offset[i + 1]; ++k) {
                const double* other = &p[3 * static_cast<std::size_t>(c_.column[k])];
                for (int d = 0; d < 3; ++d) q[d] += c_.weight[k] * (at[d] - other[d]);
            }
        });
    }

    void precondition(const Array<double>& r, Array<double>& z) const {
        parallel_for(c_.rows(), [&](Index i) {
            for (std::size_t d = 3 * static_cast<std::size_t>(i), n = 0; n < 3; ++d, ++n) z[d] = inverse_[i] * r[d];
        });
    }

private:
    const Stiffness& c_;
    double hold_;
    Array<double> inverse_;
};

/// What is left of the equations if vertices go where their motion takes them, and how large their terms were.
struct Residual {
    Array<double> values;
    double square = 0, terms = 0;
};

Residual residual_of(const Mesh& fine, const Stiffness& c, const Motion& motion, const Screened& solver) {
    Residual r{Array<double>(3 * static_cast<std::size_t>(c.rows())), 0, 0};
    struct Sums {
        double square = 0, terms = 0;
        Sums& operator+=(const Sums& o) { return square += o.square, terms += o.terms, *this; }
    };
    const Sums sums = chunked_fold<Sums>(c.rows(), [&](Sums& part, std::size_t row) {
        const auto i = static_cast<Index>(row);
        Vec3 sum = Vec3::Zero();
        for (Index k = c.offset[i]; k < c.offset[i + 1] && solver.moves(i); ++k) {
            const Index j = c.column[k];
            const Vec3 edge = fine.positions[i] - fine.positions[j];
            const Vec3 wanted = 0.5 * (motion.gradient[i] * edge + motion.gradient[j] * edge);
            const Vec3 term = c.weight[k] * (wanted - (motion.displacement[i] - motion.displacement[j]));
            sum += term;
            part.terms += c.weight[k] * c.weight[k] *
                          (motion.displacement[i].squaredNorm() + motion.displacement[j].squaredNorm());
        }
        for (int d = 0; d < 3; ++d) r.values[3 * row + d] = sum[d];
        part.square += sum.squaredNorm();
    });
    r.square = sums.square, r.terms = sums.terms;
    return r;
}

}  // namespace

Positions gradient_domain(const Mesh& fine, Motion& motion, const GradientDomainOptions& options,
                          const Progress& progress) {
    progress.report(0, "Setting up the equations");
    const Stiffness c = stiffness(fine);
    smooth_gradients(c, options.smoothing, motion.gradient, progress.part(0.2, 0.6));
    const Screened solver(c, options.hold, motion);
    Residual r = residual_of(fine, c, motion, solver);
    Positions u = motion.displacement;
    constexpr double rounding = 1e-13;  // of the terms: less is no residual
    if (!(r.square > rounding * rounding * r.terms)) return u;
    GradientsOptions how;
    how.tolerance = 1e-6;
    how.most_steps = 100;
    GradientsMemory<double> memory;
    conjugate_gradients<3, false, double>(
        r.values, how, [&](const Array<double>& p, Array<double>& q) { solver.apply(p, q); },
        [&](const Array<double>& from, Array<double>& to) { solver.precondition(from, to); },
        [&](Index i, const double* change) {
            if (!solver.moves(i)) return 0.0;
            const Vec3 step(change[0], change[1], change[2]);
            u[i] += step;
            return step.squaredNorm();
        },
        [&](int step, double) { progress.report(0.6 + 0.4 * step / (step + 15.0), "Solving"); }, memory);
    return u;
}

}  // namespace multires
