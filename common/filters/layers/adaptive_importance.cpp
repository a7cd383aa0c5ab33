#include "filters/layers/adaptive.h"

#include "base/angles.h"
#include "base/parallel.h"
#include "filters/layers/adaptive_search.h"
#include "hierarchy/collapse.h"
#include "measure/measure.h"
#include "measure/vertex_normals.h"
#include "mesh/adjacency.h"
#include "mesh/validation.h"

#include <algorithm>
#include <cmath>
#include <limits>

// How much each vertex matters to each attribute.

namespace multires {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Details of the positions by the quadrics that are summed up when vertices are removed.
/// @param rings  of the input
std::vector<double> quadric_details(const Layer& layer, const Rings& rings, const Hierarchy& h, Criterion criterion) {
    const Index n = h.vertices();
    std::vector<double> detail(n, 0);
    if (h.levels.empty()) return detail;
    const double scale = 1 / box_diagonal(layer);  // costs neither overflow nor underflow
    Positions at(n);
    parallel_for(n, [&](Index v) { at[v] = (layer.mesh.positions[v] - h.positions[0]) * scale; });
    Array<Index> place_of(n);
    parallel_for(n, [&](Index p) { place_of[h.order[p]] = p; });
    std::vector<Quadric> q(n);
    parallel_for(n, [&](Index v) {
        q[place_of[v]] = collapse::vertex_quadric(v, collapse::ring_of(rings, v), at, boundary_weight);
    });
    double weight = 0;
    for (const Quadric& quadric : q) weight += quadric.weight();
    const double average = weight / std::max<Index>(1, n - h.isolated);
    for (Index p = n - 1; p >= h.size.back(); --p) {  // children before their parents
        const Index u = h.parent[p];
        const Vec3 d = at[h.order[u]] - at[h.order[p]];
        const double moved = q[p].at(d), own = q[p].weight();
        const double square = criterion == Criterion::area_error ? (moved - q[p].c) / average
                              : own > 0                          ? moved / own
                                                                 : 0;
        detail[p] = std::sqrt(std::max(0.0, square)) / scale;
        q[u].add_moved(q[p], -d);
    }
    return detail;
}

/// The row that predicts a removed vertex.
struct Prediction {
    Star star;
    const double* weight;
    const double* flap_weight;  ///< null: the operator does not use flaps
    Index parent;
    bool kept;  ///< by its parent alone

    /// Calls term(place, weight).
    template <class Term>
    void each(const Term& term) const {
        if (kept) return term(parent, 1.0);
        for (Index j = 0; j < star.size; ++j) {
            term(star.neighbor[j], weight[j]);
            if (flap_weight) term(star.flap[j], flap_weight[j]);
        }
    }
};

/// Calls visit(place, prediction) for every removed vertex.
template <class Visit>
void for_each_prediction(const Hierarchy& h, Operator op, const Visit& visit) {
    RelaxationOptions options;
    options.op = op;
    parallel_chunks(h.odd.rows(), 512, [&](Index begin, Index end) {
        RowRelaxation relaxation(options);
        std::vector<double> weight, flap_weight;
        for (Index r = begin; r < end; ++r) {
            const Star s = star(h.odd, r);
            weight.resize(s.size);
            flap_weight.resize(s.size);
            double* const flaps = uses_flaps(op) ? flap_weight.data() : nullptr;
            const bool kept = !relaxation.row(s, h.positions, weight.data(), flaps);
            visit(s.vertex, Prediction{s, weight.data(), flaps, h.parent[s.vertex], kept});
        }
    });
}

/// Lengths of the details of a field over places: f - R f where the vertex is removed.
std::vector<double> field_details(const Hierarchy& h, const Field& f, Operator op) {
    std::vector<double> detail(h.vertices(), 0);
    for_each_prediction(h, op, [&](Index p, const Prediction& prediction) {
        double square = 0;
        for (int c = 0; c < f.width; ++c) {
            double d = f.row(p)[c];
            prediction.each([&](Index q, double weight) { d -= weight * f.row(q)[c]; });
            square += d * d;
        }
        detail[p] = std::sqrt(square);
    });
    return detail;
}

/// Details of wedges: each wedge of a vertex is predicted from the nearest wedges of its neighbours; the longest
/// counts.
std::vector<double> wedge_details(const Layer& layer, const Hierarchy& h, Operator op) {
    const std::vector<Wedge>& corner = corner_texcoords(layer);
    std::vector<std::vector<Wedge>> at(h.vertices());  // by input vertex, all different
    for (std::size_t f = 0; f < layer.mesh.faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Wedge& w = corner[3 * f + k];
            auto& list = at[layer.mesh.faces[f][k]];
            if (std::none_of(list.begin(), list.end(), [&](const Wedge& o) { return o.u == w.u && o.v == w.v; }))
                list.push_back(w);
        }
    std::vector<double> detail(h.vertices(), 0);
    for_each_prediction(h, op, [&](Index p, const Prediction& prediction) {
        for (const Wedge& own : at[h.order[p]]) {
            double u = own.u, v = own.v;
            const auto subtract = [&](Index q, double factor) {
                const Wedge* nearest = nullptr;
                const auto distance = [&](const Wedge& w) { return std::hypot(w.u - own.u, w.v - own.v); };
                for (const Wedge& w : at[h.order[q]])
                    if (!nearest || distance(w) < distance(*nearest)) nearest = &w;
                u -= factor * nearest->u, v -= factor * nearest->v;
            };
            prediction.each(subtract);
            detail[p] = std::max(detail[p], std::hypot(u, v));
        }
    });
    return detail;
}

Field unit_normals(const Layer& layer) { return field_of(vertex_normals(layer.mesh.faces, layer.mesh.positions)); }

const Attribute& attribute(const Layer& layer, AttributeKind kind, const char* message) {
    for (const Attribute& a : layer.attributes)
        if (a.kind == kind) return a;
    throw InputError(message);
}

std::vector<double> attribute_details(const Layer& layer, const Hierarchy& h, Operator op, AttributeKind kind,
                                      const char* message) {
    const Attribute& a = attribute(layer, kind, message);
    Field f;
    f.width = a.width;
    f.values.assign(a.values.begin(), a.values.end());
    for (const double value : f.values)
        if (!is_usable(value)) throw InputError(std::string(message) + " that is a number up to 1e70 everywhere");
    return field_details(h, to_places(h, f), op);
}

void require_selection(const Layer& layer) {
    const auto any = [](const std::vector<std::uint8_t>& s) { return std::find(s.begin(), s.end(), 1) != s.end(); };
    if (!any(layer.selected_vertex) && !any(layer.selected_face))
        throw InputError("region_of_interest: nothing is selected; select vertices or faces, or turn this off");
}

void keep_selection(const Layer& layer, const Hierarchy& h, std::vector<double>& importance) {
    require_selection(layer);
    const std::vector<std::uint8_t> keep = selected_region(layer);
    for (Index p = 0; p < h.vertices(); ++p)
        if (keep[h.order[p]]) importance[p] = infinity;
}

}  // namespace

std::vector<std::uint8_t> selected_region(const Layer& layer) {
    std::vector<std::uint8_t> in(layer.mesh.positions.size(), 0);
    for (std::size_t v = 0; v < layer.selected_vertex.size(); ++v) in[v] = layer.selected_vertex[v];
    for (std::size_t f = 0; f < layer.selected_face.size(); ++f)
        if (layer.selected_face[f])
            for (const Index v : layer.mesh.faces[f]) in[v] = 1;
    return in;
}

std::vector<double> importance(const Layer& layer, const Rings& rings, const Hierarchy& h, const AdaptiveOptions& o) {
    std::vector<double> largest(h.vertices(), 0);
    const auto add = [&](const DetailThreshold& t, double unit, const auto& details) {
        if (!t.use) return;
        const double threshold = t.threshold * unit;
        const std::vector<double> detail = details();
        for (Index p = 0; p < h.vertices(); ++p)
            largest[p] = std::max(largest[p], threshold > 0 ? detail[p] / threshold : infinity);
    };
    add(o.geometry, o.unit == LengthUnit::percent ? box_diagonal(layer) / 100 : 1, [&] {
        return o.criterion == Criterion::detail ? field_details(h, field_of(h.positions), o.op)
                                                : quadric_details(layer, rings, h, o.criterion);
    });
    add(o.color, 1, [&] {
        return attribute_details(layer, h, o.op, AttributeKind::color, "use_color: the mesh has no vertex colour");
    });
    add(o.quality, 1, [&] {
        return attribute_details(layer, h, o.op, AttributeKind::quality, "use_quality: the mesh has no vertex quality");
    });
    add(o.texcoord, 1, [&] {
        return !corner_texcoords(layer).empty()
                   ? wedge_details(layer, h, o.op)
                   : attribute_details(layer, h, o.op, AttributeKind::texcoord,
                                       "use_texcoord: the mesh has no texture coordinates");
    });
    add(o.normal, 1, [&] {
        std::vector<double> detail = field_details(h, to_places(h, unit_normals(layer)), o.op);
        for (double& d : detail) d = degrees(2 * std::asin(std::min(1.0, d / 2)));
        return detail;
    });
    if (o.region_of_interest) keep_selection(layer, h, largest);
    return largest;
}

}  // namespace multires
