// Loops on all threads by base/parallel.h, beside OpenMP: a pyramid's pattern, loops over levels that shrink by a
// quarter.

#include "base/array.h"
#include "base/parallel.h"

#include <benchmark/benchmark.h>

#include <algorithm>

#ifdef _OPENMP
#include <omp.h>
#endif

namespace {

using namespace multires;

constexpr Index finest = 1000000, coarsest = 1000, grain = 1024;

void average(const double* in, double* out, Index begin, Index end, Index n) {
    for (Index i = begin; i < end; ++i) out[i] = 0.5 * (in[i > 0 ? i - 1 : n - 1] + in[i + 1 < n ? i + 1 : 0]);
}

/// @param loop  loop(n, body): body(begin, end) for the chunks of 0 .. n-1
template <class Loop>
void loops_over_levels(benchmark::State& state, const Loop& loop) {
    Array<double> in(finest, 1.0), out(finest);
    for (auto _ : state) {
        for (Index n = finest; n > coarsest; n = n / 4 * 3)
            loop(n, [&](Index begin, Index end) { average(in.data(), out.data(), begin, end, n); });
        benchmark::DoNotOptimize(out.data());
    }
}

void LoopsByPool(benchmark::State& state) {
    loops_over_levels(state, [](Index n, const auto& body) { parallel_chunks(n, grain, body); });
}

#ifdef _OPENMP
/// OMP_WAIT_POLICY=passive shows it without spinning.
void LoopsByOpenMP(benchmark::State& state) {
    loops_over_levels(state, [](Index n, const auto& body) {
        const Index chunks = (n - 1) / grain + 1;
#pragma omp parallel for num_threads(thread_count())
        for (Index c = 0; c < chunks; ++c) body(c * grain, std::min(n, (c + 1) * grain));
    });
}
BENCHMARK(LoopsByOpenMP)->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kMillisecond);
#endif

BENCHMARK(LoopsByPool)->MeasureProcessCPUTime()->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
