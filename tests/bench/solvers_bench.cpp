// Smooth scans by solvers/ and by Eigen's direct solver: set-up, and solves at cutoffs of 4, 20 and 100 mean edges.
// Three right-hand sides, to 1e-8. `steps` are those of conjugate gradients; they must not grow with the mesh.

#include "scans.h"
#include "solvers/system.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

#include <cmath>
#include <complex>

namespace {

using namespace multires;

double mean_edge(const Mesh& mesh) {
    double sum = 0;
    for (const Face& f : mesh.faces)
        for (int k = 0; k < 3; ++k) sum += (mesh.positions[f[k]] - mesh.positions[f[(k + 1) % 3]]).norm();
    return sum / (3 * static_cast<double>(mesh.faces.size()));
}

/// 1 / k^2 of a cutoff in mean edges.
double stiffness_of(const Mesh& mesh, benchmark::State& state) {
    const double length = static_cast<double>(state.range(1)) * mean_edge(mesh) / (2 * std::acos(-1.0));
    return length * length;
}

void SetUpSystem(benchmark::State& state) {
    const Layer& layer = bench::scan(static_cast<Index>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(System(layer.mesh).matrices().mass.data());
    bench::per_vertex(state, layer);
}

/// M + C / k^2.
void Solve(benchmark::State& state) {
    const Layer& layer = bench::scan(static_cast<Index>(state.range(0)));
    const System system(layer.mesh);
    const double s = stiffness_of(layer.mesh, state);
    Positions rhs = layer.mesh.positions, x(rhs.size());
    for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] *= system.matrices().mass[i];
    int steps = 0;
    for (auto _ : state) {
        std::fill(x.begin(), x.end(), Vec3::Zero());
        steps = system.solve(1, s, rhs, x).steps;
    }
    state.counters["steps"] = steps;
    bench::per_vertex(state, layer);
}

/// M + i C / k^2.
void LowPass(benchmark::State& state) {
    const Layer& layer = bench::scan(static_cast<Index>(state.range(0)));
    const System system(layer.mesh);
    const double k = 1 / std::sqrt(stiffness_of(layer.mesh, state));
    Positions x(layer.mesh.positions.size());
    int steps = 0;
    for (auto _ : state) steps = system.low_pass(k, layer.mesh.positions, x).steps;
    state.counters["steps"] = steps;
    bench::per_vertex(state, layer);
}

template <class Scalar>
Eigen::SparseMatrix<Scalar> assembled(const Stiffness& c, Scalar s) {
    std::vector<Eigen::Triplet<Scalar>> entries;
    for (Index i = 0; i < c.rows(); ++i) {
        Scalar diagonal = c.mass[i];
        for (Index k = c.offset[i]; k < c.offset[i + 1]; ++k) {
            entries.emplace_back(i, c.column[k], -s * c.weight[k]);
            diagonal += s * c.weight[k];
        }
        entries.emplace_back(i, i, diagonal);
    }
    Eigen::SparseMatrix<Scalar> a(c.rows(), c.rows());
    a.setFromTriplets(entries.begin(), entries.end());
    return a;
}

/// Factorises and solves, as a new cutoff makes necessary.
template <class Solver>
void direct(benchmark::State& state, typename Solver::Scalar unit) {
    using Scalar = typename Solver::Scalar;
    const Layer& layer = bench::scan(static_cast<Index>(state.range(0)));
    const Stiffness c = stiffness(layer.mesh);
    const Eigen::SparseMatrix<Scalar> a = assembled<Scalar>(c, unit * stiffness_of(layer.mesh, state));
    Eigen::Matrix<Scalar, Eigen::Dynamic, 3> rhs(c.rows(), 3);
    for (Index i = 0; i < c.rows(); ++i) rhs.row(i) = (c.mass[i] * layer.mesh.positions[i]).transpose().cast<Scalar>();
    for (auto _ : state) {
        Solver solver;
        solver.compute(a);
        Eigen::Matrix<Scalar, Eigen::Dynamic, 3> x = solver.solve(rhs);
        benchmark::DoNotOptimize(x.data());
    }
    bench::per_vertex(state, layer);
}

void DirectSolve(benchmark::State& state) { direct<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>(state, 1); }
void DirectLowPass(benchmark::State& state) {
    direct<Eigen::SparseLU<Eigen::SparseMatrix<std::complex<double>>>>(state, {0, 1});
}

}  // namespace

BENCHMARK(SetUpSystem)->Arg(50000)->Arg(134000)->Arg(1000000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(Solve)->ArgsProduct({{50000, 134000, 1000000}, {4, 20, 100}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(LowPass)->ArgsProduct({{50000, 134000, 1000000}, {4, 20, 100}})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(DirectSolve)->Args({50000, 20})->Args({134000, 20})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(DirectLowPass)->Args({50000, 20})->Unit(benchmark::kMillisecond)->UseRealTime();
