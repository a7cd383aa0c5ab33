// Cost of a pyramid and its parts per vertex of generated scans.
// MULTIRES_THREADS=1 shows one thread.

#include "mesh/adjacency.h"
#include "pyramid/pyramid.h"
#include "scans.h"

namespace {

using namespace multires;
using bench::per_vertex;
using bench::scan;

PyramidOptions options_of(benchmark::State& state) {
    PyramidOptions o;
    if (state.range(1) == 0) {  // Roy's: cotangent weights, no presmoothing
        o.scheme.row = scheme_named("Roy");
        o.scheme.op = Operator::cotangent_clamped;
        o.scheme.presmooth = 0;
    }
    if (state.range(1) == 2) o.scheme.row = scheme_named("Lazy");
    return o;
}

void Rings(benchmark::State& state) {
    const Layer& layer = scan(static_cast<Index>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(vertex_rings(layer.mesh));
    per_vertex(state, layer);
}

void HierarchyOnly(benchmark::State& state) {
    const Layer& layer = scan(static_cast<Index>(state.range(0)));
    const multires::Rings rings = vertex_rings(layer.mesh);
    HierarchyOptions o;
    o.flaps = state.range(1) == 1;
    for (auto _ : state) benchmark::DoNotOptimize(build_hierarchy(rings, layer.mesh.positions, o));
    per_vertex(state, layer);
}

void WholePyramid(benchmark::State& state) {
    const Layer& layer = scan(static_cast<Index>(state.range(0)));
    const PyramidOptions o = options_of(state);
    for (auto _ : state) benchmark::DoNotOptimize(Pyramid(layer, o, Progress()));
    per_vertex(state, layer);
}

void Synthesis(benchmark::State& state) {
    const Layer& layer = scan(static_cast<Index>(state.range(0)));
    const Pyramid pyramid(layer, options_of(state), Progress());
    const std::vector<double> gain(pyramid.levels().size() - 1, 0.5);
    for (auto _ : state) benchmark::DoNotOptimize(pyramid.scheme().synthesise(pyramid.coefficients(), with_gain(gain)));
    per_vertex(state, layer);
}

void ContentHash(benchmark::State& state) {
    const Layer& layer = scan(static_cast<Index>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(content_hash(layer, {}));
    per_vertex(state, layer);
}

// Second argument: 0 Roy with cotangent weights, 1 the default (Guskov, second differences with flaps, presmoothed), 2
// the same but lazy.
#define SIZES(mode)                                                                                                    \
    Args({48485, mode})->Args({1000000, mode})->Args({10000000, mode})->Unit(benchmark::kMillisecond)->UseRealTime()
BENCHMARK(Rings)->SIZES(1);
BENCHMARK(HierarchyOnly)->SIZES(0)->SIZES(1);
BENCHMARK(WholePyramid)->SIZES(0)->SIZES(1)->SIZES(2);
BENCHMARK(Synthesis)->SIZES(0)->SIZES(1)->SIZES(2);
BENCHMARK(ContentHash)->SIZES(1);

}  // namespace
