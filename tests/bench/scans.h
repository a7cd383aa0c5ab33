#pragma once

#include "mesh/layer.h"
#include "shapes.h"

#include <benchmark/benchmark.h>

#include <map>

namespace multires::bench {

/// A generated scan, made once per size.
inline const Layer& scan(Index vertices) {
    static std::map<Index, Layer> kept;
    Layer& layer = kept[vertices];
    if (layer.mesh.positions.empty()) layer.mesh = shapes::scan(vertices);
    return layer;
}

/// Reports the time per vertex of the layer.
inline void per_vertex(benchmark::State& state, const Layer& layer) {
    state.counters["per_vertex"] =
        benchmark::Counter(static_cast<double>(layer.mesh.positions.size()),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

}  // namespace multires::bench
