#include "all_tables.h"
#include "base/parallel.h"
#include "bytes.h"
#include "given.h"

#include "../unit/result_numbers.h"

#include <algorithm>

// Any filter, any parameters, any small mesh: connectivity and coordinates as the fuzzer likes them, with NaN and edges
// of many faces. It must work, and give numbers that are finite and indices in range, or refuse with an InputError.
// Hierarchy, operators and transforms are all under the filters.

namespace multires::fuzz {
namespace {

using namespace plugin;

const std::vector<const Filter*>& filters() {
    static const std::vector<const Filter*> all = all_filters();
    return all;
}

Attribute attribute(AttributeKind kind, const char* name, int width, std::size_t vertices, Bytes& in) {
    Attribute a{kind, name, width, {}};
    const bool given = in.byte() & 1;
    for (std::size_t i = 0; i < vertices * width; ++i)
        a.values.push_back(given ? in.number() : static_cast<double>((7 * i) % 16));
    return a;
}

std::vector<std::uint8_t> bits(std::size_t count, int most, Bytes& in) {
    std::vector<std::uint8_t> out;
    if (!(in.byte() & 1)) return out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(static_cast<std::uint8_t>(in.below(most)));
    return out;
}

/// A grid with some other faces among its own.
void add_grid(Mesh& mesh, Bytes& in) {
    const int rows = 2 + in.below(10), columns = 2 + in.below(10);
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) mesh.positions.emplace_back(j, i, in.number());
    for (int i = 0; i + 1 < rows; ++i)
        for (int j = 0; j + 1 < columns; ++j) {
            const Index a = i * columns + j, d = a + columns;
            const int damage = in.byte();
            if (damage != 1) mesh.faces.push_back({a, a + 1, d + 1});
            if (damage != 2) mesh.faces.push_back({a, d + 1, d});
            if (damage == 3) mesh.faces.push_back({in.below(rows * columns), in.below(rows * columns), a});
        }
}

Layer layer_from(bool grid, Bytes& in) {
    Layer layer;
    Mesh& mesh = layer.mesh;
    if (grid && (in.byte() & 3)) add_grid(mesh, in);
    const bool done = !mesh.faces.empty();
    const int vertices = done ? 0 : in.below(64), faces = vertices ? in.below(128) : 0;
    for (int i = 0; i < vertices; ++i) {
        const double x = in.number(), y = in.number(), z = in.number();
        mesh.positions.emplace_back(x, y, z);
    }
    for (int i = 0; i < faces; ++i) {
        const Index a = in.below(vertices), b = in.below(vertices), c = in.below(vertices);
        mesh.faces.push_back({a, b, c});
    }
    const std::size_t n = mesh.positions.size(), m = mesh.faces.size();
    const int has = in.byte();
    if (has & 1) layer.attributes.push_back(attribute(AttributeKind::color, "", 4, n, in));
    if (has & 2) layer.attributes.push_back(attribute(AttributeKind::quality, "", 1, n, in));
    if (has & 4) layer.attributes.push_back(attribute(AttributeKind::texcoord, "", 2, n, in));
    if (has & 8) layer.attributes.push_back(attribute(AttributeKind::scalar, "heat", 1, n, in));
    if (has & 16) layer.attributes.push_back(attribute(AttributeKind::point, "flow", 3, n, in));
    if (has & 32)
        for (std::size_t i = 0; i < 3 * m; ++i) {
            const double u = in.number(), v = in.number();
            layer.wedges.push_back({u, v, in.below(3) - 1});
        }
    layer.selected_vertex = bits(n, 2, in);
    layer.selected_face = bits(m, 2, in);
    layer.faux_edges = bits(m, 8, in);
    layer.selected_edges = bits(m, 8, in);
    return layer;
}

/// A value in or near the parameter's range; counts stay small, so that a call takes no time.
double value_of(const Declared& d, Bytes& in) {
    const int how = in.byte();
    switch (d.type) {
    case Declared::Type::boolean:
    case Declared::Type::choice:
        return how % (static_cast<int>(d.most) + 1);
    case Declared::Type::integer:
        return std::min(d.most, std::max(d.least, 0.0) + how % 24);
    case Declared::Type::real:
        if (how < 64) return how / 8.0;
        if (how < 96) return std::max(d.least, -1e30) + std::min(d.most - d.least, 1e30) * (how - 64) / 31;
        return in.number();
    case Declared::Type::text:
        break;
    }
    return 0;
}

Given parameters(const Filter& filter, const Layer& layer, Bytes& in) {
    std::map<std::string, double> values;
    for (const Declared& d : declared(filter, &layer))
        if (in.byte() & 1) values[d.name] = value_of(d, in);
    return values;
}

void check(const Layer& layer, const Result& r) {
    const std::size_t n = layer.mesh.positions.size(), m = layer.mesh.faces.size();
    for (const double x : fixtures::numbers(r)) FUZZ_REQUIRE(std::isfinite(x));
    FUZZ_REQUIRE(!r.positions || r.positions->size() == n);
    FUZZ_REQUIRE(!r.quality || r.quality->size() == n);
    FUZZ_REQUIRE(!r.wedges || r.wedges->size() == 3 * m);
    for (const Attribute& a : r.attributes) FUZZ_REQUIRE(a.values.size() == n * a.width);
    if (!r.layer) return;
    const auto in = [](Index i, std::size_t count) { return i >= 0 && static_cast<std::size_t>(i) < count; };
    for (const Index v : r.layer->source_vertex) FUZZ_REQUIRE(in(v, n));
    for (const Index f : r.layer->source_face) FUZZ_REQUIRE(in(f, m));
    for (const Face& f : r.layer->faces)
        for (const Index v : f) FUZZ_REQUIRE(in(v, r.layer->source_vertex.size()));
    FUZZ_REQUIRE(r.layer->source_face.size() == r.layer->faces.size());
}

}  // namespace
}  // namespace multires::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace multires;
    set_thread_count(1);
    fuzz::Bytes in(data, size);
    const plugin::Filter& filter = *fuzz::filters()[in.below(static_cast<int>(fuzz::filters().size()))];
    // The mesh last, so that longer inputs are larger meshes.
    fuzz::Bytes rest(data + std::min<std::size_t>(size, 64), size - std::min<std::size_t>(size, 64));
    const Layer layer = fuzz::layer_from(plugin::wants_grid(filter), rest);
    const plugin::Given given = fuzz::parameters(filter, layer, in);
    Session session;
    try {
        fuzz::check(layer, run(filter, layer, session, given));
        ++fuzz::worked;
    } catch (const InputError&) {
    }
    return 0;
}
