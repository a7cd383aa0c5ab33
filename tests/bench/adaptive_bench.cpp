// Cost of adaptive reconstruction and of its parts, per vertex of generated scans.
// MULTIRES_THREADS=1 shows one thread. tests/bench/adaptive_compare.py compares with other programs.

#include "filters/layers/adaptive.h"
#include "measure/distance.h"
#include "scans.h"

namespace {

using namespace multires;
using bench::per_vertex;
using bench::scan;

AdaptiveOptions tenth_of(const Layer& layer) {
    AdaptiveOptions o;
    o.target = Target::faces;
    o.faces = static_cast<int>(layer.mesh.faces.size() / 10);
    o.measure = false;
    return o;
}

Result run(const Layer& layer, const AdaptiveOptions& o) {
    Session session;
    return adaptive_reconstruction(layer, o, session);
}

void AdaptiveHierarchy(benchmark::State& state) {
    const Layer& layer = scan(static_cast<Index>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(adaptive_hierarchy(layer, adaptive_rings(layer, {}), {}, Progress()));
    per_vertex(state, layer);
}

void AdaptiveInsertion(benchmark::State& state) {
    const Layer& layer = scan(static_cast<Index>(state.range(0)));
    const Rings rings = adaptive_rings(layer, {});
    const Hierarchy h = adaptive_hierarchy(layer, rings, {}, Progress());
    for (auto _ : state) benchmark::DoNotOptimize(insertion_order(h, importance(layer, rings, h, {})));
    per_vertex(state, layer);
}

void AdaptiveTenth(benchmark::State& state) {
    const Layer& layer = scan(static_cast<Index>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(run(layer, tenth_of(layer)));
    per_vertex(state, layer);
}

void AdaptiveTenthFitted(benchmark::State& state) {
    const Layer& layer = scan(static_cast<Index>(state.range(0)));
    AdaptiveOptions o = tenth_of(layer);
    o.fit = true;
    for (auto _ : state) benchmark::DoNotOptimize(run(layer, o));
    per_vertex(state, layer);
}

void TwoSidedDistance(benchmark::State& state) {
    const Layer& layer = scan(static_cast<Index>(state.range(0)));
    const Result r = run(layer, tenth_of(layer));
    Positions positions;
    for (const Index v : r.layer->source_vertex) positions.push_back(layer.mesh.positions[v]);
    for (auto _ : state)
        benchmark::DoNotOptimize(two_sided_distance(layer.mesh.faces, layer.mesh.positions, r.layer->faces, positions));
    per_vertex(state, layer);
}

#define SIZES Arg(35000)->Arg(500000)->Unit(benchmark::kMillisecond)->UseRealTime()
BENCHMARK(AdaptiveHierarchy)->SIZES;
BENCHMARK(AdaptiveInsertion)->SIZES;
BENCHMARK(AdaptiveTenth)->SIZES;
BENCHMARK(AdaptiveTenthFitted)->SIZES;
BENCHMARK(TwoSidedDistance)->SIZES;

}  // namespace
