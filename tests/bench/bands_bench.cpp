#include "scans.h"

#include "filters/shape/band_filters.h"
#include "measure/measure.h"

#include <benchmark/benchmark.h>

#include <string>

// The two methods of the low pass on the same scan, cutoffs in mean edges: cold (nothing kept with the mesh) and kept
// (a slider step).

namespace multires {
namespace {

void run(benchmark::State& state, BandMethod method, LowPassOrder order, bool kept) {
    const Layer& layer = bench::scan(static_cast<Index>(state.range(0)));
    LowPassOptions options;
    options.cutoff = static_cast<double>(state.range(1)) * mean_edge_length(layer.mesh.faces, layer.mesh.positions);
    options.calibration.method = method;
    options.calibration.order = order;
    Session session;
    if (kept) low_pass(layer, options, session);
    for (auto _ : state) {
        if (!kept) session = {};
        benchmark::DoNotOptimize(low_pass(layer, options, session));
    }
}

const auto registered = [] {
    struct Row {
        const char* name;
        BandMethod method;
        LowPassOrder order;
    };
    for (const Row& row : {Row{"pyramid", BandMethod::pyramid, LowPassOrder::second},
                           Row{"spline 1", BandMethod::spline, LowPassOrder::first},
                           Row{"spline 2", BandMethod::spline, LowPassOrder::second},
                           Row{"spline 4", BandMethod::spline, LowPassOrder::fourth},
                           Row{"spline gaussian", BandMethod::spline, LowPassOrder::gaussian}})
        for (const bool kept : {false, true})
            for (const int vertices : {100'000, 134'000, 1'000'000})
                for (const int edges : {4, 20, 60}) {
                    const std::string name = std::string("LowPass/") + row.name + (kept ? "/kept" : "/cold");
                    benchmark::RegisterBenchmark(name.c_str(),
                                                 [=](benchmark::State& s) { run(s, row.method, row.order, kept); })
                        ->Args({vertices, edges})
                        ->Unit(benchmark::kMillisecond)
                        ->UseRealTime();
                }
    return 0;
}();

}  // namespace
}  // namespace multires
