#include "solvers/system.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/reduce.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>

namespace multires {
namespace {

void require_finite(ConstRows rows, const char* what) {
    const std::size_t count = static_cast<std::size_t>(rows.rows) * rows.width;
    struct Any {
        bool bad = false;
        Any& operator+=(const Any& o) {
            bad |= o.bad;
            return *this;
        }
    };
    const Any any = chunked_reduce<Any>(count, [&](std::size_t begin, std::size_t end) {
        Any found;
        for (std::size_t i = begin; i < end; ++i) found.bad |= !std::isfinite(rows.values[i]);
        return found;
    });
    require(!any.bad, std::string(what) + " holds values that are not finite.");
}

void require_shape(ConstRows rows, const Stiffness& matrices, int width) {
    if (rows.rows != matrices.rows() || rows.width != width)
        throw std::invalid_argument("System: arrays of different shapes");
}

/// q += s (the hubs' part of C) p for active rows.
template <int Stride>
void apply_hubs(const Stiffness& c, const Array<std::uint8_t>& active, double s, const Array<double>& p,
                Array<double>& q) {
    using Row = Eigen::Array<double, Stride, 1>;
    const auto at = [](auto& values, Index i) { return values.data() + static_cast<std::size_t>(i) * Stride; };
    for (std::size_t h = 0; h < c.hub.size(); ++h) {
        const Row centre = Eigen::Map<const Row>(at(p, c.hub[h]));
        Row sum = Row::Zero(), stars = Row::Zero();
        for (Index k = c.hub_offset[h]; k < c.hub_offset[h + 1]; ++k)
            sum += c.hub_weight[k] * Eigen::Map<const Row>(at(p, c.hub_column[k]));
        for (Index k = c.hub_offset[h]; k < c.hub_offset[h + 1]; ++k) {
            const Index j = c.hub_column[k];
            const Row star = c.hub_star[k] * (Eigen::Map<const Row>(at(p, j)) - centre);
            stars += star;
            if (active[j]) Eigen::Map<Row>(at(q, j)) += s * (c.hub_weight[k] * sum - star);
        }
        if (active[c.hub[h]]) Eigen::Map<Row>(at(q, c.hub[h])) += s * stars;
    }
}

/// q = (z M + s C) p for active rows; the rows of the others are 0 in p and q.
template <int L, bool Z>
void apply(const Stiffness& c, const Array<std::uint8_t>& active, std::complex<double> z, double s,
           const Array<double>& p, Array<double>& q) {
    constexpr int stride = Z ? 2 * L : L;
    using Row = Eigen::Array<double, stride, 1>;
    const auto row = [](const Array<double>& v, Index i) {
        return Row(Eigen::Map<const Row>(v.data() + static_cast<std::size_t>(i) * stride));
    };
    parallel_for(c.rows(), [&](Index i) {
        Eigen::Map<Row> out(q.data() + static_cast<std::size_t>(i) * stride);
        if (!active[i]) {
            out.setZero();
            return;
        }
        const Row own = row(p, i);
        Row sum = Row::Zero(), m = c.mass[i] * own;
        if (c.mass_weight.empty()) {
            for (Index k = c.offset[i]; k < c.offset[i + 1]; ++k) sum += c.weight[k] * (own - row(p, c.column[k]));
        } else {
            for (Index k = c.offset[i]; k < c.offset[i + 1]; ++k) {
                const Row difference = own - row(p, c.column[k]);
                sum += c.weight[k] * difference;
                m -= c.mass_weight[k] * difference;
            }
        }
        sum *= s;
        if constexpr (Z) {
            sum.template head<L>() += z.real() * m.template head<L>() - z.imag() * m.template tail<L>();
            sum.template tail<L>() += z.real() * m.template tail<L>() + z.imag() * m.template head<L>();
        } else {
            sum += z.real() * m;
        }
        out = sum;
    });
    apply_hubs<stride>(c, active, s, p, q);
}

/// Some channels of a system: which, and what they are divided by to have the size of 1.
struct Group {
    int first = 0, count = 0;
    std::array<double, 4> scale{};
};

struct Family {
    const Stiffness& matrices;
    const Array<std::uint8_t>& active;
    const Multigrid& grid;
    Shift scaled;          ///< of the masses scaled to a mean of 1, divided by `by`
    Shift preconditioner;  ///< the same, definite
    double mass_scale, by;
};

/// Solves for the change of x that leaves no residual, for up to L channels.
/// @param factor  of the change of x; its real part is added
template <int L, bool Z>
GradientsResult correct_group(const Family& family, const Array<double>& residual, const Group& group,
                              std::complex<double> factor, Rows x, const SolveOptions& options,
                              const Progress& progress) {
    constexpr int stride = Z ? 2 * L : L;
    const Index n = family.matrices.rows();
    SolveMemory own, &memory = options.memory ? *options.memory : own;
    Array<double>& r = memory.residual;
    r.resize(static_cast<std::size_t>(n) * stride);
    parallel_for(n, [&](Index i) {
        const double* const from = residual.data() + static_cast<std::size_t>(i) * x.width + group.first;
        double* const to = r.data() + static_cast<std::size_t>(i) * stride;
        std::fill(to, to + stride, 0.0);
        for (int c = 0; c < group.count && family.active[i]; ++c) to[c] = from[c] / group.scale[c];
    });
    VCycle<L, Z> cycle(family.grid, family.preconditioner);
    const std::complex<double> z = family.scaled.mass * family.mass_scale;
    GradientsOptions how;
    how.tolerance = options.tolerance;
    how.most_steps = options.most_steps;
    how.together = options.together;
    how.enough = options.enough;
    return conjugate_gradients<L, Z, float>(
        r, how,
        [&](const Array<double>& p, Array<double>& q) {
            apply<L, Z>(family.matrices, family.active, z, family.scaled.stiffness, p, q);
        },
        [&](const Array<double>& from, Array<float>& to) { cycle.apply(from, to); },
        [&](Index i, const double* change) {
            double* const to = x.values + static_cast<std::size_t>(i) * x.width + group.first;
            double square = 0;
            for (int c = 0; c < group.count; ++c) {
                double part = factor.real() * change[c];
                if constexpr (Z) part -= factor.imag() * change[L + c];
                part *= group.scale[c] / family.by;
                to[c] += part;
                square += part * part;
            }
            return square;
        },
        [&](int, double left) {
            const double done = std::log(std::max(left, 1e-300)) / std::log(std::max(options.tolerance, 1e-6));
            progress.report(std::clamp(done, 0.0, 1.0), "Solving");
        },
        memory.gradients);
}

/// The largest value of each channel at active rows, 1 for those that are 0.
std::array<double, 4> scales(const Array<double>& values, int width, int first, int count,
                             const Array<std::uint8_t>& active, bool together) {
    struct Most {
        std::array<double, 4> of{};
        Most& operator+=(const Most& o) {
            for (int c = 0; c < 4; ++c) of[c] = std::max(of[c], o.of[c]);
            return *this;
        }
    };
    Most most = chunked_reduce<Most>(active.size(), [&](std::size_t begin, std::size_t end) {
        Most found;
        for (std::size_t i = begin; i < end; ++i)
            for (int c = 0; c < count && active[i]; ++c)
                found.of[c] = std::max(found.of[c], std::abs(values[i * width + first + c]));
        return found;
    });
    if (together) most.of.fill(*std::max_element(most.of.begin(), most.of.end()));
    for (double& m : most.of)
        if (!(m > 0)) m = 1;
    return most.of;
}

/// Components of the mesh in which a system without mass is not definite, and what is kept in them: the mean.
class Floating {
public:
    Floating(const Stiffness& matrices, const Array<std::uint8_t>& active, const std::vector<std::uint8_t>& fixed)
        : matrices_(matrices), active_(active), components_(components(matrices)), held_(components_.count, 0) {
        for (Index i = 0; i < matrices.rows(); ++i)
            if (!active[i] && (fixed.empty() || fixed[i] || matrices.offset[i] == matrices.offset[i + 1]))
                held_[components_.of[i]] = 1;
    }
    Index count() const { return static_cast<Index>(std::count(held_.begin(), held_.end(), 0)); }

    /// Sums over each component of weight x values, one channel. @param weight  null: 1
    std::vector<double> sums(const double* values, int width, int channel, bool by_mass) const {
        std::vector<double> sum(components_.count, 0);
        for (Index i = 0; i < matrices_.rows(); ++i)
            sum[components_.of[i]] += (by_mass ? weight(i) : 1) * values[static_cast<std::size_t>(i) * width + channel];
        return sum;
    }
    /// Takes from floating components what no solution could balance: their sum, spread by mass.
    void balance(Array<double>& residual, int width) const {
        const std::vector<double> mass = masses();
        for (int c = 0; c < width; ++c) {
            const std::vector<double> sum = sums(residual.data(), width, c, false);
            for (Index i = 0; i < matrices_.rows(); ++i)
                if (const Index of = components_.of[i]; !held_[of])
                    residual[static_cast<std::size_t>(i) * width + c] -= weight(i) / mass[of] * sum[of];
        }
    }
    /// Adds what makes the means of floating components what they were.
    void restore(const std::vector<std::vector<double>>& before, Rows x) const {
        const std::vector<double> mass = masses();
        for (int c = 0; c < x.width; ++c) {
            const std::vector<double> now = sums(x.values, x.width, c, true);
            for (Index i = 0; i < matrices_.rows(); ++i)
                if (const Index of = components_.of[i]; !held_[of])
                    x.values[static_cast<std::size_t>(i) * x.width + c] += (before[c][of] - now[of]) / mass[of];
        }
    }

private:
    double weight(Index i) const { return active_[i] ? std::max(matrices_.mass[i], 1e-300) : 0; }
    std::vector<double> masses() const {
        std::vector<double> sum(components_.count, 0);
        for (Index i = 0; i < matrices_.rows(); ++i) sum[components_.of[i]] += weight(i);
        return sum;
    }

    const Stiffness& matrices_;
    const Array<std::uint8_t>& active_;
    Components components_;
    std::vector<std::uint8_t> held_;
};

}  // namespace

System::System(const Mesh& mesh, const SystemOptions& options, const Progress& progress) {
    const std::size_t n = mesh.positions.size();
    require(options.fixed.empty() || options.fixed.size() == n, "There must be a mark for every vertex.");
    progress.report(0, "Setting up the solver");
    matrices_ = multires::stiffness(mesh, options.stiffness, options.fixed);
    fixed_ = options.fixed;
    active_.resize(n);
    double mass = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const bool lonely = matrices_.offset[i] == matrices_.offset[i + 1], free = fixed_.empty() || !fixed_[i];
        active_[i] = free && !lonely;
        without_faces_ += free && lonely;
        mass += matrices_.mass[i];
    }
    mass_scale_ = mass > 0 ? static_cast<double>(n) / mass : 1;
    if (options.bending) {
        matrices_ = bending(matrices_);
        unit_ = mass_scale_;
    }
    grid_ = std::make_unique<const Multigrid>(matrices_, active_, mass_scale_, progress.part(0.3, 1));
}

Solved System::correct(const Shift& shift, std::complex<double> factor, bool singular, const Array<double>& residual,
                       Rows x, const SolveOptions& options, const Progress& progress) const {
    const double by = std::abs(shift.mass) / mass_scale_ + shift.stiffness;
    const Shift scaled{shift.mass / (mass_scale_ * by), shift.stiffness / by};
    Shift definite = scaled;
    // Below the smallest eigenvalue of a piece of any size, which is about 4 pi^2 / vertices.
    if (singular) definite.mass += scaled.stiffness / static_cast<double>(std::max<Index>(1, matrices_.rows()));
    if (scaled.mass.real() < 0) definite.mass = {0, std::copysign(std::abs(scaled.mass), scaled.mass.imag())};
    const Family family{matrices_, active_, *grid_, scaled, definite, mass_scale_, by};
    Solved solved;
    solved.without_faces = without_faces_;
    for (int first = 0; first < x.width;) {
        Group group{first, x.width - first == 1 ? 1 : std::min(4, x.width - first), {}};
        group.scale = scales(residual, x.width, first, group.count, active_, options.together);
        const Progress part =
            progress.part(static_cast<double>(first) / x.width, static_cast<double>(first + group.count) / x.width);
        const auto run = [&](auto lanes, auto complex) {
            return correct_group<decltype(lanes)::value, decltype(complex)::value>(family, residual, group, factor, x,
                                                                                   options, part);
        };
        using One = std::integral_constant<int, 1>;
        using Four = std::integral_constant<int, 4>;
        const GradientsResult result =
            shift.real() ? (group.count == 1 ? run(One{}, std::false_type{}) : run(Four{}, std::false_type{}))
                         : (group.count == 1 ? run(One{}, std::true_type{}) : run(Four{}, std::true_type{}));
        solved.steps = std::max(solved.steps, result.steps);
        solved.residual = std::max(solved.residual, result.residual);
        solved.converged = solved.converged && result.converged;
        first += group.count;
    }
    return solved;
}

Solved System::solve(double mass, double stiffness, ConstRows rhs, Rows x, const SolveOptions& options,
                     const Progress& progress) const {
    require(mass >= 0 && stiffness >= 0 && mass + stiffness > 0 && std::isfinite(mass + stiffness),
            "A system needs weights of mass and stiffness that are not negative, and one of them not 0.");
    require_shape(rhs, matrices_, x.width);
    require_shape(ConstRows(x), matrices_, x.width);
    require_finite(rhs, "The right-hand side");
    require_finite(x, "The first guess");
    stiffness *= unit_;
    Array<double> residual(static_cast<std::size_t>(x.rows) * x.width), massive(residual.size());
    apply_stiffness(matrices_, x.values, x.width, residual.data());
    apply_mass(matrices_, x.values, x.width, massive.data());
    parallel_for(x.rows, [&](Index i) {
        for (int c = 0; c < x.width; ++c) {
            const std::size_t at = static_cast<std::size_t>(i) * x.width + c;
            residual[at] = active_[i] ? rhs.values[at] - stiffness * residual[at] - mass * massive[at] : 0;
        }
    });
    if (mass > 0) return correct({mass, stiffness}, 1, false, residual, x, options, progress);
    const Floating floating(matrices_, active_, fixed_);
    if (floating.count() == 0) return correct({0, stiffness}, 1, false, residual, x, options, progress);
    std::vector<std::vector<double>> before(x.width);
    for (int c = 0; c < x.width; ++c) before[c] = floating.sums(x.values, x.width, c, true);
    floating.balance(residual, x.width);
    Solved solved = correct({0, stiffness}, 1, true, residual, x, options, progress);
    floating.restore(before, x);
    solved.floating = floating.count();
    return solved;
}

Solved System::rational(const std::vector<Term>& terms, double s, ConstRows f, Rows out, const SolveOptions& options,
                        const Progress& progress) const {
    require(s >= 0 && std::isfinite(s), "The weight of the stiffness must not be negative.");
    s *= unit_;
    double constant = 0;
    for (const Term& term : terms) {
        require(term.pole.real() >= -10 * std::abs(term.pole.imag()) && std::abs(term.pole) > 0 &&
                    std::isfinite(std::abs(term.pole)),
                "The poles of a filter must not be 0, nor near the negative real axis.");
        constant += (term.weight / term.pole).real();
    }
    if (std::abs(constant - 1) < 1e-12) constant = 1;  // so that constants stay exactly
    require_shape(f, matrices_, f.width);
    require_shape(ConstRows(out), matrices_, f.width);
    require_finite(f, "The signal");
    SolveMemory own, &memory = options.memory ? *options.memory : own;
    Array<double>& bent = memory.right;  // C f: what each term changes comes from it
    bent.resize(static_cast<std::size_t>(f.rows) * f.width);
    apply_stiffness(matrices_, f.values, f.width, bent.data());
    parallel_for(f.rows, [&](Index i) {
        for (std::size_t k = static_cast<std::size_t>(i) * f.width, c = 0; c < static_cast<std::size_t>(f.width); ++c)
            out.values[k + c] = constant * f.values[k + c];
    });
    SolveOptions how = options;
    how.memory = &memory;
    Solved solved;
    for (std::size_t j = 0; j < terms.size(); ++j) {
        const double begin = static_cast<double>(j) / static_cast<double>(terms.size());
        const double end = static_cast<double>(j + 1) / static_cast<double>(terms.size());
        const Solved one = correct({terms[j].pole, s}, -s * terms[j].weight / terms[j].pole, false, bent, out, how,
                                   progress.part(begin, end));
        solved.steps = std::max(solved.steps, one.steps);
        solved.residual = std::max(solved.residual, one.residual);
        solved.converged = solved.converged && one.converged;
        solved.without_faces = one.without_faces;
    }
    return solved;
}

Solved System::low_pass(double wave_number, ConstRows f, Rows out, const SolveOptions& options,
                        const Progress& progress) const {
    require(wave_number > 0 && std::isfinite(wave_number), "The wave number of a cutoff must be positive.");
    const std::complex<double> i(0, 1);  // (M + i s C)^-1 = -i (-i M + s C)^-1
    return rational({{-i, -i}}, 1 / (wave_number * wave_number), f, out, options, progress);
}

}  // namespace multires
