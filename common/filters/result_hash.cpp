#include "filters/result_hash.h"

#include "base/hash.h"

namespace multires {

double result_hash(const Result& result) {
    Hash hash;
    const auto add_positions = [&](const Positions& p) { hash.add(p.data(), p.size() * sizeof(Vec3)); };
    if (result.positions) add_positions(*result.positions);
    if (result.quality) hash.add(*result.quality);
    for (const Attribute& a : result.attributes) hash.add(a.values);
    if (result.wedges)
        for (const Wedge& w : *result.wedges) hash.add(std::array{w.u, w.v, static_cast<double>(w.texture)});
    if (result.selected_vertex) hash.add(*result.selected_vertex);
    if (result.selected_edges) hash.add(*result.selected_edges);
    if (result.layer) {
        hash.add(result.layer->source_vertex);
        hash.add(result.layer->faces);
        hash.add(result.layer->source_face);
        if (result.layer->positions) add_positions(*result.layer->positions);
        for (const Attribute& a : result.layer->attributes) hash.add(a.values);
    }
    return hash.empty() ? 0 : static_cast<double>(hash.bits64() >> 12);
}

}  // namespace multires
