// Cost of relaxation weights per row on one thread, beside a plain gather of the ring positions (the memory traffic
// that any operator has).

#include "mesh/adjacency.h"
#include "operators/relaxation.h"
#include "shapes.h"

#include "base/parallel.h"
#include <benchmark/benchmark.h>

namespace {

using namespace multires;

struct Input {
    Mesh mesh = shapes::scan(200000);
    Rings rings = vertex_rings(mesh);
    Input() { find_flaps(rings); }
};

const Input& input() {
    static const Input kept;
    return kept;
}

void per_row(benchmark::State& state) {
    state.counters["per_row"] =
        benchmark::Counter(static_cast<double>(input().rings.rows()),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void GatherRings(benchmark::State& state) {
    const Input& in = input();
    std::vector<double> weight(in.rings.neighbor.size());
    for (auto _ : state) {
        for (Index r = 0; r < in.rings.rows(); ++r) {
            const Vec3 center = in.mesh.positions[in.rings.vertex(r)];
            for (Index k = in.rings.offset[r]; k < in.rings.offset[r + 1]; ++k) {
                weight[k] = (in.mesh.positions[in.rings.neighbor[k]] - center).x();
            }
        }
        benchmark::DoNotOptimize(weight.data());
    }
    per_row(state);
}

void Weights(benchmark::State& state, Operator op) {
    const Input& in = input();
    const int threads = thread_count();
    set_thread_count(1);
    RelaxationOptions options;
    options.op = op;
    for (auto _ : state) {
        benchmark::DoNotOptimize(ring_weights(in.rings, in.mesh.positions, options).weight.data());
    }
    set_thread_count(threads);
    per_row(state);
}

/// A sweep with kept weights over a million vertices in scan order, on all threads, and a plain copy that moves as many
/// bytes: weights, columns and offsets read, values read and written.
struct Sweep {
    Mesh mesh = shapes::scan(1000000);
    multires::Rings rings = vertex_rings(mesh);
    RingWeights weights = ring_weights(rings, mesh.positions);
    Positions out = mesh.positions;
    std::size_t bytes = weights.weight.size() * 12 + mesh.positions.size() * (4 + 2 * sizeof(Vec3));

    static Sweep& instance() {
        static Sweep kept;
        return kept;
    }
};

void RelaxationSweep(benchmark::State& state) {
    Sweep& s = Sweep::instance();
    for (auto _ : state) {
        relax(s.rings, s.weights, s.mesh.positions, s.out);
        benchmark::DoNotOptimize(s.out.data());
    }
    state.SetBytesProcessed(static_cast<std::int64_t>(s.bytes) * state.iterations());
}

void CopyOfAsManyBytes(benchmark::State& state) {
    const std::size_t half = Sweep::instance().bytes / 2;
    const Array<char> from(half, 1);
    Array<char> to(half, 0);
    for (auto _ : state) {
        parallel_chunks(static_cast<Index>(half), 1 << 18, [&](Index begin, Index end) {
            std::copy(from.begin() + begin, from.begin() + end, to.begin() + begin);
        });
        benchmark::DoNotOptimize(to.data());
    }
    state.SetBytesProcessed(static_cast<std::int64_t>(2 * half) * state.iterations());
}

BENCHMARK(GatherRings)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Weights, umbrella, Operator::umbrella)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Weights, cotangent, Operator::cotangent)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Weights, cotangent_clamped, Operator::cotangent_clamped)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Weights, cotangent_delaunay, Operator::cotangent_delaunay)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Weights, second_difference, Operator::second_difference)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Weights, second_difference_flaps, Operator::second_difference_flaps)->Unit(benchmark::kMillisecond);
BENCHMARK(RelaxationSweep)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(CopyOfAsManyBytes)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
