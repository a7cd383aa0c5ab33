#include "base/error.h"
#include "fixtures.h"
#include "solvers/system.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <cmath>
#include <complex>
#include <limits>
#include <string>
#include <vector>

namespace multires {

using namespace fixtures;

namespace {

Eigen::MatrixXd dense(const Stiffness& c) {
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(c.rows(), c.rows());
    for (Index i = 0; i < c.rows(); ++i)
        for (Index k = c.offset[i]; k < c.offset[i + 1]; ++k) {
            full(i, c.column[k]) -= c.weight[k];
            full(i, i) += c.weight[k];
        }
    return full;
}

Eigen::VectorXd masses(const Stiffness& c) { return Eigen::Map<const Eigen::VectorXd>(c.mass.data(), c.rows()); }

Array<double> random_values(std::size_t count, std::uint64_t seed) {
    shapes::Random random(seed);
    Array<double> values(count);
    for (double& v : values) v = random.uniform(-1, 1);
    return values;
}

double mean_edge(const Mesh& mesh) {
    double sum = 0;
    for (const Face& f : mesh.faces)
        for (int k = 0; k < 3; ++k) sum += (mesh.positions[f[k]] - mesh.positions[f[(k + 1) % 3]]).norm();
    return sum / (3 * static_cast<double>(mesh.faces.size()));
}

double difference(const Positions& a, const Positions& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
    return most;
}

/// Marks of the vertices on open rims.
std::vector<std::uint8_t> rim(const Mesh& mesh) {
    const Rings rings = vertex_rings(mesh);
    std::vector<std::uint8_t> marks(mesh.positions.size());
    for (std::size_t i = 0; i < marks.size(); ++i) marks[i] = rings.kind[i] != RingKind::closed;
    return marks;
}

/// Every class, and what is worse.
std::vector<std::pair<std::string, Mesh>> all_meshes() {
    auto all = every_class();
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        all.emplace_back("soup " + std::to_string(seed), random_soup(seed));
        all.emplace_back("damaged " + std::to_string(seed), damaged_mesh(seed));
    }
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        all.emplace_back("not finite", shapes::not_finite(bad));
    Mesh sliver{{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0}, {0.5, 1, 0}, {0.4, -1, 0}},
                {{0, 1, 3}, {0, 2, 1}, {0, 4, 2}, {2, 4, 1}}};
    all.emplace_back("sliver", sliver);
    return all;
}

}  // namespace

TEST(Stiffness, IsSymmetricAndSemidefiniteWithRowsThatSumToZeroOnEveryMesh) {
    for (const auto& [name, mesh] : all_meshes()) {
        const Stiffness c = stiffness(mesh);
        for (const double m : c.mass) ASSERT_TRUE(m >= 0 && std::isfinite(m)) << name;
        const std::size_t n = mesh.positions.size();
        Array<double> ones(n, 3.7), out(n);
        apply_stiffness(c, ones.data(), 1, out.data());
        for (const double v : out) ASSERT_EQ(v, 0) << name;
        if (n > 700) continue;
        const Eigen::MatrixXd full = dense(c);
        EXPECT_EQ(full, full.transpose()) << name;
        const Eigen::VectorXd pivots = full.ldlt().vectorD();  // as many negative ones as eigenvalues
        EXPECT_GT(pivots.minCoeff(), -1e-14 * std::max(1.0, pivots.maxCoeff())) << name;
    }
}

TEST(Stiffness, IsTheEnergyOfLinearFunctionsAndMassesSumToTheArea) {
    // A linear function of gradient g on a planar mesh of area 1 has the energy g^2, whatever the triangles.
    for (const std::uint64_t seed : {1, 2, 3}) {
        const Mesh mesh = shapes::plane(12, {0.45, 0.9, seed});
        const Stiffness c = stiffness(mesh);
        Array<double> f(mesh.positions.size()), cf(f.size());
        for (std::size_t i = 0; i < f.size(); ++i) f[i] = 3 * mesh.positions[i].x() - 4 * mesh.positions[i].y() + 1;
        apply_stiffness(c, f.data(), 1, cf.data());
        double energy = 0, area = 0;
        for (std::size_t i = 0; i < f.size(); ++i) energy += f[i] * cf[i], area += c.mass[i];
        EXPECT_NEAR(energy, 25, 1e-11);
        EXPECT_NEAR(area, 1, 1e-13);
    }
}

TEST(Stiffness, DoesNotDependOnScaleAndMotion) {
    const Mesh mesh = shapes::scan(700);
    const Stiffness c = stiffness(mesh);
    for (const double scale : {1e-60, 1.0, 1e60}) {
        Motion motion;
        motion.scale = scale;
        motion.offset *= scale;
        const Stiffness moved = stiffness(motion(mesh));
        ASSERT_EQ(moved.column, c.column);
        for (std::size_t k = 0; k < c.weight.size(); ++k) EXPECT_NEAR(moved.weight[k], c.weight[k], 1e-10);
        for (std::size_t i = 0; i < c.mass.size(); ++i) EXPECT_NEAR(moved.mass[i] / (scale * scale), c.mass[i], 1e-12);
    }
}

TEST(System, SolvesAsADenseSolverDoes) {
    for (const auto& [name, mesh] : all_meshes()) {
        const std::size_t n = mesh.positions.size();
        if (n > 1500) continue;
        std::vector<std::uint8_t> fixed(n, 0);
        for (std::size_t i = 0; i < n; i += 7) fixed[i] = 1;
        const System system(mesh, {{}, fixed});
        const Stiffness& c = system.matrices();
        const double area = masses(c).sum() / static_cast<double>(n);
        if (!(area > 0)) continue;
        const Array<double> b = random_values(2 * n, 5), guess = random_values(2 * n, 6);
        Array<double> x = guess;
        SolveOptions exact;
        exact.tolerance = 1e-13;
        const double mass = 1 / area;
        system.solve(mass, 3, ConstRows(b, 2), Rows(x, 2), exact);

        std::vector<Index> free;
        for (Index i = 0; i < c.rows(); ++i)
            if (!fixed[i] && c.offset[i] < c.offset[i + 1]) free.push_back(i);
        Eigen::MatrixXd full = 3 * dense(c);
        full.diagonal() += mass * masses(c);
        Eigen::MatrixXd right = Eigen::Map<const Eigen::Matrix<double, -1, 2, Eigen::RowMajor>>(b.data(), n, 2);
        const Eigen::MatrixXd all = Eigen::Map<const Eigen::Matrix<double, -1, 2, Eigen::RowMajor>>(x.data(), n, 2);
        const Eigen::MatrixXd left = full * all - right;
        double most = 0;
        for (const Index i : free) most = std::max(most, left.row(i).cwiseAbs().maxCoeff());
        const double norm = full.cwiseAbs().rowwise().sum().maxCoeff() * std::max(1.0, all.cwiseAbs().maxCoeff());
        EXPECT_LT(most, 1e-10 * norm) << name;
        if (name != "sliver" && full.diagonal().maxCoeff() < 1e5) {
            Eigen::MatrixXd small(free.size(), free.size());
            Eigen::MatrixXd rhs(free.size(), 2), mine(free.size(), 2);
            for (std::size_t r = 0; r < free.size(); ++r) {
                for (std::size_t s = 0; s < free.size(); ++s) small(r, s) = full(free[r], free[s]);
                rhs.row(r) = right.row(free[r]), mine.row(r) = all.row(free[r]);
                for (Index k = 0; k < c.rows(); ++k)
                    if (fixed[k]) rhs.row(r) -= full(free[r], k) * all.row(k);
            }
            const Eigen::MatrixXd expected = small.ldlt().solve(rhs);
            EXPECT_LT((mine - expected).cwiseAbs().maxCoeff(), 1e-8 * (1 + expected.cwiseAbs().maxCoeff())) << name;
        }
        for (std::size_t i = 0; i < n; ++i)
            if (fixed[i] || c.offset[i] == c.offset[i + 1]) {
                EXPECT_EQ(x[2 * i], guess[2 * i]) << name;
                EXPECT_EQ(x[2 * i + 1], guess[2 * i + 1]) << name;
            }
    }
}

TEST(System, LowPassIsThatOfTheFourthOrderEquation) {
    for (const auto& [name, mesh] : all_meshes()) {
        const std::size_t n = mesh.positions.size();
        if (n > 800) continue;
        const System system(mesh);
        const Stiffness& c = system.matrices();
        if (!(masses(c).minCoeff() > 0)) continue;
        const Eigen::MatrixXd full = dense(c);
        const double s = 2 * masses(c).mean();
        const Array<double> f = random_values(n, 9);
        Array<double> g(n, 0.0);
        SolveOptions exact;
        exact.tolerance = 1e-12;
        const Solved solved = system.low_pass(1 / std::sqrt(s), ConstRows(f, 1), Rows(g, 1), exact);
        EXPECT_TRUE(solved.converged) << name;
        const auto error = [&](const Eigen::VectorXd& expected) {
            return (expected - Eigen::Map<const Eigen::VectorXd>(g.data(), n)).cwiseAbs().maxCoeff();
        };
        const Eigen::VectorXd m = masses(c), mf = m.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(f.data(), n));
        Eigen::MatrixXcd shifted = std::complex<double>(0, s) * full.cast<std::complex<double>>();
        shifted.diagonal() += m.cast<std::complex<double>>();
        // Rounding, ours and the reference's, grows with the stiffest edge.
        const double limit = 1e-8 * std::max(1.0, full.diagonal().maxCoeff() / 1e6);
        EXPECT_LT(error(shifted.partialPivLu().solve(mf.cast<std::complex<double>>()).real()), limit) << name;
        if (full.diagonal().maxCoeff() > 1e4) continue;  // too badly conditioned for the fourth order in dense form
        Eigen::MatrixXd square = s * s * full * m.cwiseInverse().asDiagonal() * full;
        square.diagonal() += m;
        EXPECT_LT(error(square.ldlt().solve(mf)), 1e-8) << name;
    }
}

TEST(System, RationalFiltersHaveTheGainsOfTheirTerms) {
    const Mesh mesh = shapes::scan(600);
    const System system(mesh);
    const Stiffness& c = system.matrices();
    const std::size_t n = mesh.positions.size();
    const double s = 3 * masses(c).mean();
    const std::vector<Term> terms = {{{0.2, 1.5}, {0.3, -0.4}}, {{1, 0}, {0.5, 0.1}}, {{0.5, -2}, {1, 1}}};
    const Array<double> f = random_values(n, 2);
    Array<double> g(n);
    SolveOptions exact;
    exact.tolerance = 1e-12;
    system.rational(terms, s, ConstRows(f, 1), Rows(g, 1), exact);
    Eigen::VectorXcd expected = Eigen::VectorXcd::Zero(n);
    const Eigen::VectorXcd m = masses(c).cast<std::complex<double>>();
    for (const Term& term : terms) {
        Eigen::MatrixXcd a = s * dense(c).cast<std::complex<double>>();
        a.diagonal() += term.pole * m;
        expected +=
            term.weight * a.partialPivLu().solve(m.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(f.data(), n)));
    }
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(g[i], expected[i].real(), 1e-8);
}

/// What the hubs add to the entries.
Eigen::MatrixXd dense_hubs(const Stiffness& c) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(c.rows(), c.rows());
    for (std::size_t h = 0; h < c.hub.size(); ++h) {
        Eigen::VectorXd u = Eigen::VectorXd::Zero(c.rows());
        for (Index k = c.hub_offset[h]; k < c.hub_offset[h + 1]; ++k) {
            const Index i = c.hub[h], j = c.hub_column[k];
            u[j] = c.hub_weight[k];
            if (i == j) continue;
            sum(i, i) -= c.hub_star[k], sum(j, j) -= c.hub_star[k];
            sum(i, j) += c.hub_star[k], sum(j, i) += c.hub_star[k];
        }
        sum += u * u.transpose();
    }
    return sum;
}

TEST(System, BendingIsTheSquareOfTheStiffness) {
    std::size_t hubs = 0;
    for (const auto& [name, mesh] : all_meshes()) {
        const std::size_t n = mesh.positions.size();
        const Stiffness c = stiffness(mesh);
        const double mean = masses(c).mean();
        if (n > 700 || !(masses(c).minCoeff() > 1e-5 * mean)) continue;
        const Stiffness square = bending(c);
        const Eigen::VectorXd inverse = masses(c).cwiseInverse();
        const Eigen::MatrixXd full = dense(square) + dense_hubs(square);
        const Eigen::MatrixXd expected = mean * dense(c) * inverse.asDiagonal() * dense(c);
        EXPECT_EQ(full, full.transpose()) << name;
        EXPECT_LT((full - expected).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff()) << name;
        const Eigen::VectorXd x = Eigen::VectorXd::Random(static_cast<Index>(n));
        Eigen::VectorXd applied(x.size());
        apply_stiffness(square, x.data(), 1, applied.data());
        EXPECT_LT((applied - full * x).cwiseAbs().maxCoeff(), 1e-12 * full.cwiseAbs().maxCoeff()) << name;
        hubs += square.hub.size();
    }
    EXPECT_GT(hubs, 0U);
}

TEST(System, LinearFunctionsOnPlanesHaveNoBendingEnergy) {
    // Fixed: the rim and its neighbours, whose conditions are not those of the plane, and every ninth vertex.
    for (const Index size : {12, 60}) {
        const Mesh mesh = shapes::plane(size, {0.3, 0.3, 3});
        std::vector<std::uint8_t> fixed = rim(mesh);
        const std::vector<std::uint8_t> first = fixed;
        for (const Face& f : mesh.faces)
            for (const Index v : f) fixed[v] |= first[f[0]] | first[f[1]] | first[f[2]];
        for (std::size_t i = 0; i < fixed.size(); i += 9) fixed[i] = 1;
        for (const double scale : {1e-40, 1.0, 1e40}) {
            Motion motion;
            motion.scale = scale;
            motion.offset *= scale;
            const Mesh moved = motion(mesh);
            const System system(moved, {{}, fixed, true});
            Positions x = moved.positions;
            for (std::size_t i = 0; i < x.size(); ++i)
                if (!fixed[i]) x[i] = motion(Vec3(0.5, 0.5, 0.2));
            const Solved solved = system.solve(0, 1, Positions(x.size(), Vec3::Zero()), x);
            EXPECT_TRUE(solved.converged);
            EXPECT_LT(difference(x, moved.positions), 1e-6 * scale) << solved.steps;
        }
    }
}

TEST(System, ConstantsStay) {
    for (const auto& [name, mesh] : every_class()) {
        const System system(mesh);
        const Positions constant(mesh.positions.size(), Vec3(1, -2, 1e6));
        Positions out(constant.size());
        system.low_pass(3, constant, out);
        EXPECT_EQ(out, constant) << name;
    }
}

TEST(System, LinearFunctionsOnPlanesAreHarmonic) {
    for (const shapes::Irregular& irregular : {shapes::Irregular{0.3, 0.3, 1}, shapes::Irregular{0.45, 0.9, 2}}) {
        const Mesh mesh = shapes::plane(60, irregular);
        const std::vector<std::uint8_t> fixed = rim(mesh);
        const Motion motion;
        const Mesh moved = motion(mesh);
        const System system(moved, {{}, fixed});
        Positions x = moved.positions;
        for (std::size_t i = 0; i < x.size(); ++i)
            if (!fixed[i]) x[i] = Vec3(1, 1, 1);
        const Positions zero(x.size(), Vec3::Zero());
        const Solved solved = system.solve(0, 1, zero, x);
        EXPECT_TRUE(solved.converged);
        EXPECT_EQ(solved.floating, 0);
        EXPECT_LT(difference(x, moved.positions), 1e-6);
    }
}

TEST(System, WithoutMassFloatingComponentsKeepTheirMean) {
    const Mesh mesh = shapes::join(shapes::join(shapes::icosphere(5), shapes::torus(12, 9), Vec3(4, 0, 0)),
                                   shapes::plane(6), Vec3(0, 5, 0));
    std::vector<std::uint8_t> fixed(mesh.positions.size(), 0);
    fixed.back() = 1;  // holds the plane
    const System system(mesh, {{}, fixed});
    const Stiffness& c = system.matrices();
    const Components parts = components(c);
    ASSERT_EQ(parts.count, 3);
    const Array<double> b = random_values(c.rows(), 3), guess = random_values(c.rows(), 4);
    Array<double> x = guess;
    const Solved solved = system.solve(0, 1, ConstRows(b, 1), Rows(x, 1));
    EXPECT_TRUE(solved.converged);
    EXPECT_EQ(solved.floating, 2);
    Array<double> cx(x.size());
    apply_stiffness(c, x.data(), 1, cx.data());
    std::vector<double> mass(3, 0), before(3, 0), after(3, 0), load(3, 0);
    for (Index i = 0; i < c.rows(); ++i) {
        mass[parts.of[i]] += c.mass[i];
        before[parts.of[i]] += c.mass[i] * guess[i];
        after[parts.of[i]] += c.mass[i] * x[i];
        load[parts.of[i]] += b[i];
    }
    for (Index i = 0; i < c.rows(); ++i) {
        const Index part = parts.of[i];
        const double balanced = part < 2 ? b[i] - load[part] * c.mass[i] / mass[part] : b[i];
        if (!fixed[i]) {
            EXPECT_NEAR(cx[i], balanced, 1e-6);
        }
    }
    for (const int part : {0, 1}) EXPECT_NEAR(after[part], before[part], 1e-12 * mass[part]);
}

TEST(System, GainOfLowPassIsThatOfTheSplineFilterOnSpheres) {
    // Eigenvalues of the sphere are l (l + 1); the error falls with the square of the edge.
    std::vector<double> error;
    for (const Index frequency : {12, 24, 48}) {
        const Mesh mesh = shapes::icosphere(frequency);
        const System system(mesh);
        double most = 0;
        for (const Index degree : {2, 5, 9}) {
            const std::vector<double> h = shapes::harmonic(mesh.positions, degree, 7);
            const Array<double> f(h.begin(), h.end());
            Array<double> g(f.size());
            const double k = 6, q2 = degree * (degree + 1.0) / (k * k);
            system.low_pass(k, ConstRows(f, 1), Rows(g, 1));
            double along = 0, norm = 0, rest = 0;
            for (std::size_t i = 0; i < f.size(); ++i) {
                along += system.matrices().mass[i] * f[i] * g[i];
                norm += system.matrices().mass[i] * f[i] * f[i];
            }
            for (std::size_t i = 0; i < f.size(); ++i)
                rest += system.matrices().mass[i] * std::pow(g[i] - f[i] / (1 + q2 * q2), 2);
            most = std::max({most, std::abs(along / norm - 1 / (1 + q2 * q2)), std::sqrt(rest / norm)});
        }
        error.push_back(most);
    }
    EXPECT_LT(error[0], 0.02);
    EXPECT_LT(error[1], error[0] / 3.5);
    EXPECT_LT(error[2], error[1] / 3.5);
}

TEST(System, LowPassFollowsMotionAndScale) {
    const Mesh mesh = shapes::scan(3000);
    const double k = 2 * pi / (15 * mean_edge(mesh));
    Positions out(mesh.positions.size()), moved(out.size());
    System(mesh).low_pass(k, mesh.positions, out);
    for (const double scale : {1e-50, 1.0, 1e50}) {
        Motion motion;
        motion.scale = scale;
        motion.offset *= scale;
        const Mesh other = motion(mesh);
        System(other).low_pass(k / scale, other.positions, moved);
        double most = 0;
        for (std::size_t i = 0; i < out.size(); ++i) most = std::max(most, (moved[i] - motion(out[i])).norm() / scale);
        EXPECT_LT(most, 1e-7) << scale;
    }
}

TEST(System, ChannelsSolvedTogetherTurnTheSolutionAfterAnyNumberOfSteps) {
    const Mesh mesh = shapes::scan(4000);
    const System system(mesh);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vec3(0.3, -0.8, 0.5).normalized()).toRotationMatrix();
    Positions turned = mesh.positions;
    for (Vec3& p : turned) p = turn * p;
    const double k = 2 * pi / (20 * mean_edge(mesh));
    const auto largest = [&](bool together, int steps) {
        SolveOptions options;
        options.together = together;
        options.most_steps = steps;
        Positions here(turned.size()), there(turned.size());
        system.low_pass(k, mesh.positions, here, options);
        system.low_pass(k, turned, there, options);
        double most = 0;
        for (std::size_t i = 0; i < here.size(); ++i) most = std::max(most, (turn * here[i] - there[i]).norm());
        return most / mean_edge(mesh);
    };
    for (const int steps : {1, 3, 6}) EXPECT_LT(largest(true, steps), 1e-6) << steps;
    EXPECT_GT(largest(false, 3), 1e-4);  // each alone goes another way
}

TEST(System, EndsWithAStepThatIsSmallEnough) {
    for (const double noise : {0.0, 0.3}) {
        Mesh mesh = shapes::scan(4000);
        const double edge = mean_edge(mesh);
        const Array<double> random = random_values(mesh.positions.size() * 3, 5);
        for (std::size_t i = 0; i < random.size(); ++i) mesh.positions[i / 3][i % 3] += noise * edge * random[i];
        const System system(mesh);
        for (const double edges : {4.0, 20.0, 100.0}) {
            const double k = 2 * pi / (edges * edge);
            SolveOptions exact, early;
            exact.tolerance = 1e-12;
            early.enough = 1e-4 * edge, early.together = true, early.tolerance = 1e-12;
            Positions a(mesh.positions.size()), b(a.size());
            const Solved all = system.low_pass(k, mesh.positions, a, exact);
            const Solved some = system.low_pass(k, mesh.positions, b, early);
            EXPECT_TRUE(some.converged);
            EXPECT_LT(some.steps, all.steps * 0.8);
            double squares = 0;
            for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]).squaredNorm();
            EXPECT_LT(std::sqrt(squares / static_cast<double>(a.size())), 1e-4 * edge) << noise << ", " << edges;
        }
    }
}

TEST(System, SameBitsForAnyNumberOfThreads) {
    const Mesh mesh = shapes::scan(30000);
    const double k = 2 * pi / (20 * mean_edge(mesh));
    std::vector<Positions> low, smooth;
    for (const int count : {1, 2, 5}) {
        const Threads threads(count);
        const System system(mesh);
        low.emplace_back(mesh.positions.size());
        system.low_pass(k, mesh.positions, low.back());
        smooth.push_back(mesh.positions);
        system.solve(0, 1, low.back(), smooth.back());
    }
    EXPECT_EQ(low[1], low[0]);
    EXPECT_EQ(low[2], low[0]);
    EXPECT_EQ(smooth[1], smooth[0]);
    EXPECT_EQ(smooth[2], smooth[0]);
}

TEST(System, StepsDoNotGrowWithTheMesh) {
    std::vector<std::vector<int>> steps;
    for (const Index vertices : {10000, 160000}) {
        const Mesh mesh = shapes::scan(vertices);
        const System system(mesh);
        std::vector<int> of;
        for (const double edges : {4, 20, 100}) {
            const double k = 2 * pi / (edges * mean_edge(mesh));
            const std::vector<double> h = shapes::harmonic(mesh.positions, 3, 1);
            shapes::Random random(4);
            Array<double> f(h.begin(), h.end()), b(f.size()), x(f.size(), 0.0);
            for (double& v : f) v += random.uniform(-0.3, 0.3);
            for (std::size_t i = 0; i < f.size(); ++i) b[i] = f[i] * system.matrices().mass[i];
            of.push_back(system.solve(1, 1 / (k * k), ConstRows(b, 1), Rows(x, 1)).steps);
            of.push_back(system.low_pass(k, ConstRows(f, 1), Rows(x, 1)).steps);
        }
        steps.push_back(of);
    }
    for (std::size_t i = 0; i < steps[0].size(); ++i) {
        EXPECT_LE(steps[1][i], 1.5 * steps[0][i]) << i;
        EXPECT_LE(steps[1][i], 30) << i;
    }
}

TEST(System, CanBeCancelled) {
    const Mesh mesh = shapes::scan(3000);
    int calls = 0;
    const Progress count([&](int, const char*) { return ++calls > 0; });
    const System system(mesh, {}, count);
    Positions out(mesh.positions.size());
    system.low_pass(50, mesh.positions, out, {}, count);
    ASSERT_GT(calls, 8);
    for (int at = 0; at < calls; ++at) {
        int left = at;
        const Progress stop([&](int, const char*) { return left-- > 0; });
        EXPECT_THROW(
            {
                const System again(mesh, {}, stop);
                again.low_pass(50, mesh.positions, out, {}, stop);
            },
            Cancelled);
    }
}

TEST(System, RefusesWhatIsNotDefinite) {
    const Mesh mesh = shapes::icosphere(3);
    const System system(mesh);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Positions x = mesh.positions;
    for (const auto& [mass, stiffness] : {std::pair{-1.0, 1.0}, {1.0, -1.0}, {0.0, 0.0}, {nan, 1.0}})
        EXPECT_THROW(system.solve(mass, stiffness, mesh.positions, x), InputError);
    EXPECT_THROW(system.low_pass(0, mesh.positions, x), InputError);
    EXPECT_THROW(system.low_pass(nan, mesh.positions, x), InputError);
    EXPECT_THROW(system.rational({{{-1, 0.05}, 1}}, 1, mesh.positions, x), InputError);
    EXPECT_THROW(system.rational({{0, 1}}, 1, mesh.positions, x), InputError);
    Positions bad = mesh.positions;
    bad[3].y() = nan;
    EXPECT_THROW(system.low_pass(1, bad, x), InputError);
    EXPECT_THROW(system.solve(1, 1, bad, x), InputError);
    EXPECT_THROW(System(mesh, {{}, {1, 0}}), InputError);
}

}  // namespace multires
