#pragma once

#include "filters/filter.h"

#include <variant>
#include <vector>

namespace multires::fixtures {

/// All numbers of a result in one row: what it changes, then what it reports.
inline std::vector<double> numbers(const Result& r) {
    std::vector<double> out;
    const auto positions = [&](const Positions& p) {
        for (const Vec3& v : p) out.insert(out.end(), v.data(), v.data() + 3);
    };
    if (r.positions) positions(*r.positions);
    if (r.quality) out.insert(out.end(), r.quality->begin(), r.quality->end());
    for (const Attribute& a : r.attributes) out.insert(out.end(), a.values.begin(), a.values.end());
    if (r.wedges)
        for (const Wedge& w : *r.wedges) out.insert(out.end(), {w.u, w.v, static_cast<double>(w.texture)});
    for (const auto* bits : {&r.selected_vertex, &r.selected_edges})
        if (*bits) out.insert(out.end(), (*bits)->begin(), (*bits)->end());
    if (r.layer) {
        out.insert(out.end(), r.layer->source_vertex.begin(), r.layer->source_vertex.end());
        out.insert(out.end(), r.layer->source_face.begin(), r.layer->source_face.end());
        for (const Face& f : r.layer->faces) out.insert(out.end(), f.begin(), f.end());
        if (r.layer->positions) positions(*r.layer->positions);
        for (const Attribute& a : r.layer->attributes) out.insert(out.end(), a.values.begin(), a.values.end());
    }
    for (const Report::Entry& e : r.report.entries())
        std::visit(
            [&](const auto& value) {
                if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::vector<double>>)
                    out.insert(out.end(), value.begin(), value.end());
                else
                    out.push_back(static_cast<double>(value));
            },
            e.value);
    return out;
}

}  // namespace multires::fixtures
