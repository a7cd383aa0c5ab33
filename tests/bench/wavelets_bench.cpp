// Szczesna's lifting: time of its parts, and the entropy of its quantised details by predictor: what the tables of
// docs/wavelets.md come from. With MULTIRES_MESHES=FOLDER the entropies are those of its .off files, too.

#include "mesh/adjacency.h"
#include "scans.h"
#include "schemes/table.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace {

using namespace multires;

struct Predictor {
    const char* name;
    Operator op;
};
constexpr Predictor predictors[] = {{"second_difference_flaps", Operator::second_difference_flaps},
                                    {"cotangent", Operator::cotangent},
                                    {"cotangent_delaunay", Operator::cotangent_delaunay},
                                    {"natural_neighbours", Operator::natural_neighbours},
                                    {"thin_plate_1_ring", Operator::thin_plate},
                                    {"thin_plate_2_ring", Operator::thin_plate_flaps}};

HierarchyOptions grouped(bool sequential) {
    HierarchyOptions options;
    options.even_rings = false;
    options.grouping = sequential ? Grouping::sequential : Grouping::independent_sets;
    return options;
}

SchemeOptions szczesna(Operator op, Update update) {
    SchemeOptions options;
    options.row = scheme_named("Szczesna");
    options.op = op;
    options.update = update;
    return options;
}

void Weights(benchmark::State& state, Operator op, bool sequential) {
    const Layer& layer = bench::scan(static_cast<Index>(state.range(0)));
    const Hierarchy h = build_hierarchy(vertex_rings(layer.mesh), layer.mesh.positions, grouped(sequential));
    for (auto _ : state) benchmark::DoNotOptimize(make_scheme(h, szczesna(op, Update::mean)));
    bench::per_vertex(state, layer);
}

void Analysis(benchmark::State& state, bool sequential) {
    const Layer& layer = bench::scan(static_cast<Index>(state.range(0)));
    const Hierarchy h = build_hierarchy(vertex_rings(layer.mesh), layer.mesh.positions, grouped(sequential));
    const auto scheme = make_scheme(h, szczesna(Operator::second_difference_flaps, Update::mean));
    for (auto _ : state) benchmark::DoNotOptimize(scheme->analyse(field_of(h.positions)));
    bench::per_vertex(state, layer);
    state.counters["bytes_per_vertex"] = static_cast<double>(bytes(h) + scheme->bytes()) / h.vertices();
}

/// Bits that an ideal coder takes for integers whose frequencies it knows.
double entropy(std::vector<long> values) {
    std::sort(values.begin(), values.end());
    double bits = 0;
    for (auto at = values.begin(); at != values.end();) {
        const auto next = std::upper_bound(at, values.end(), *at);
        const double count = static_cast<double>(next - at);
        bits -= count * std::log2(count / static_cast<double>(values.size()));
        at = next;
    }
    return bits;
}

/// Bits a vertex of the details' three components, in steps of 1 / 4096 of the longest side of the box. Details of
/// each factor of two in vertices have frequencies of their own.
double bits_per_vertex(const Hierarchy& h, const Coefficients& c) {
    Vec3 lo = h.positions[0], hi = lo;
    for (const Vec3& p : h.positions) lo = lo.cwiseMin(p), hi = hi.cwiseMax(p);
    const double step = (hi - lo).maxCoeff() / 4096;
    std::vector<std::vector<long>> bin(3 * 32);
    for (const auto& level : c.level)
        for (Index r = 0; r < level[0].rows(); ++r) {
            const auto octave = static_cast<std::size_t>(std::log2(std::max(256, level[0].place(r))));
            for (std::size_t k = 0; k < 3; ++k)
                bin[3 * octave + k].push_back(std::lround(level[0].values.row(r)[k] / step));
        }
    double bits = 0;
    for (const std::vector<long>& values : bin) bits += entropy(values);
    return bits / h.vertices();
}

void Entropy(benchmark::State& state, const std::function<Mesh()>& make, Operator op, Update update) {
    const Mesh mesh = make();
    const Hierarchy h = build_hierarchy(vertex_rings(mesh), mesh.positions, grouped(state.range(0) != 0));
    const auto scheme = make_scheme(h, szczesna(op, update));
    Coefficients c;
    for (auto _ : state) c = scheme->analyse(field_of(h.positions));
    state.counters["bits"] = bits_per_vertex(h, c);
}

Mesh read_off(const std::filesystem::path& path) {
    std::ifstream in(path);
    std::string word;
    std::size_t vertices = 0, faces = 0, edges = 0;
    in >> word >> vertices >> faces >> edges;
    Mesh mesh;
    mesh.positions.resize(vertices);
    mesh.faces.resize(faces);
    for (Vec3& p : mesh.positions) in >> p.x() >> p.y() >> p.z();
    for (Face& f : mesh.faces) in >> edges >> f[0] >> f[1] >> f[2];
    return mesh;
}

/// @param make  the mesh, when it is wanted
void register_entropies(const std::string& name, const std::function<Mesh()>& make) {
    for (const Predictor& p : predictors)
        for (const Update update : {Update::mean, Update::none}) {
            const std::string row =
                "Entropy/" + name + "/" + p.name + (update == Update::mean ? "/mean" : "/no_update");
            benchmark::RegisterBenchmark(row.c_str(),
                                         [=](benchmark::State& state) { Entropy(state, make, p.op, update); })
                ->Arg(0)
                ->Arg(1)
                ->Iterations(1);
        }
}

const bool registered = [] {
    register_entropies("scan", [] { return shapes::scan(20000); });
    register_entropies("sphere", [] { return shapes::irregular_sphere(10000); });
    register_entropies("block", [] { return shapes::block(24); });
    if (const char* folder = std::getenv("MULTIRES_MESHES"))
        for (const auto& file : std::filesystem::directory_iterator(folder))
            if (file.path().extension() == ".off")
                register_entropies(file.path().stem(), [path = file.path()] { return read_off(path); });
    return true;
}();

BENCHMARK_CAPTURE(Weights, sets, Operator::second_difference_flaps, false)->Arg(48000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Weights, sequential, Operator::second_difference_flaps, true)
    ->Arg(48000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Weights, natural, Operator::natural_neighbours, false)->Arg(48000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Weights, plate, Operator::thin_plate, false)->Arg(48000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Analysis, sets, false)->Arg(48000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Analysis, sequential, true)->Arg(48000)->Unit(benchmark::kMillisecond);

}  // namespace
