#include "filters/attributes/attributes.h"

#include "base/angles.h"
#include "base/parallel.h"
#include "mesh/adjacency.h"
#include "mesh/validation.h"
#include "mesh/wedge_charts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace multires {
namespace {

void check(const AttributeRelaxationOptions& o) {
    if (o.iterations < 1) throw InputError("iterations must be at least 1");
    if (!(o.strength > 0 && o.strength <= 1)) throw InputError("strength must be more than 0 and at most 1");
    if (!(o.corner_angle >= 0 && o.corner_angle <= 180))
        throw InputError("corner_angle must be between 0 and 180 degrees");
}

/// The operator on a mesh, and how much of each step its vertices take.
struct Relaxation {
    Rings rings;
    RingWeights weights;
    std::vector<double> step;  ///< #V, 0 where the value is kept
};

bool is_open(const Rings& rings, Index v) { return rings.kind[v] == RingKind::open; }

/// The two neighbours of an open ring's vertex along the boundary.
std::pair<Index, Index> along(const Rings& rings, Index v) {
    return {rings.begin(v)[0], rings.begin(v)[rings.size(v) - 1]};
}

/// @param weights  of the region, by vertex of `layer`, or empty
Relaxation make_relaxation(const Layer& layer, const AttributeRelaxationOptions& options,
                           const std::vector<double>& weights) {
    Relaxation r;
    const Positions& p = layer.mesh.positions;
    r.rings = surface_rings(layer.mesh);
    mark_features(r.rings, layer, options.features, options.feature_angle);
    if (uses_flaps(options.op)) find_flaps(r.rings);
    RelaxationOptions relaxation_options;
    relaxation_options.op = options.op;
    relaxation_options.close_holes = false;  // both sides of a seam of texture charts relax by the same weights
    r.weights = ring_weights(r.rings, p, relaxation_options);

    const double least_cosine = std::cos(radians(options.corner_angle));
    const Array<double> stable = stable_steps(r.rings, r.weights);
    r.step.resize(p.size());
    parallel_for(r.rings.rows(), [&](Index v) {
        r.step[v] = stable[v] * options.strength * (weights.empty() ? 1 : weights[v]);
        if (!is_open(r.rings, v)) return;
        const auto [a, b] = along(r.rings, v);
        const Vec3 in = p[v] - p[a], out = p[b] - p[v];
        if (in.dot(out) < least_cosine * in.norm() * out.norm()) r.step[v] = 0;
    });
    for (const Index v : r.weights.fixed) r.step[v] = 0;
    return r;
}

/// One step. Differences are summed, not values: where all neighbours agree nothing moves, not even by rounding.
template <int Width>
void take_step(const Relaxation& r, const std::vector<double>& step, const Field& f, Field& out) {
    const bool flaps = !r.weights.flap_weight.empty();
    parallel_for(r.rings.rows(), [&](Index v) {
        const double* here = f.row(v);
        double sum[Width] = {};
        const auto add = [&](double weight, const double* there) {
            for (int c = 0; c < Width; ++c) sum[c] += weight * (there[c] - here[c]);
        };
        if (step[v] > 0)
            for (Index k = r.rings.offset[v]; k < r.rings.offset[v + 1]; ++k) {
                add(r.weights.weight[k], f.row(r.rings.neighbor[k]));
                if (flaps) add(r.weights.flap_weight[k], f.row(r.rings.flap[k]));
            }
        for (int c = 0; c < Width; ++c) out.row(v)[c] = here[c] + step[v] * sum[c];
    });
}

Field relaxed(const Relaxation& r, const std::vector<double>& step, Field f, int iterations, const Progress& progress) {
    Field next = f;
    for (int i = 0; i < iterations; ++i) {
        progress.report(static_cast<double>(i) / iterations, "Relaxing attributes");
        switch (f.width) {
        case 1:
            take_step<1>(r, step, f, next);
            break;
        case 2:
            take_step<2>(r, step, f, next);
            break;
        case 3:
            take_step<3>(r, step, f, next);
            break;
        case 4:
            take_step<4>(r, step, f, next);
            break;
        default:
            throw std::invalid_argument("attributes have 1 to 4 channels");
        }
        std::swap(f, next);
    }
    return f;
}

int count_kept(const Relaxation& r, const std::vector<double>& weights) {
    Index kept = 0;
    for (std::size_t v = 0; v < r.step.size(); ++v) kept += r.step[v] == 0 && (weights.empty() || weights[v] > 0);
    return static_cast<int>(kept);
}

/// The steps, but none on the boundary.
std::vector<double> inner_steps(const Relaxation& r) {
    std::vector<double> step = r.step;
    for (Index v = 0; v < r.rings.rows(); ++v)
        if (is_open(r.rings, v)) step[v] = 0;
    return step;
}

/// Keeps nodes on an outline that does not simply pass through their vertex: where a seam ends, its two sides are one
/// edge; where it branches, the nodes of the vertex see different edges.
void keep_seam_ends(Relaxation& r, const CutMesh& cut) {
    const auto ends = [&](Index node) {
        const auto [a, b] = along(r.rings, node);
        return std::minmax({cut.vertex[a], cut.vertex[b]});
    };
    for (std::size_t v = 0; v + 1 < cut.nodes_of.size(); ++v) {
        const Index begin = cut.nodes_of[v], end = cut.nodes_of[v + 1];
        bool passes = true;
        for (Index n = begin; n < end && passes; ++n) {
            if (is_open(r.rings, n))
                passes = is_open(r.rings, begin) && ends(n) == ends(begin) && ends(n).first != ends(n).second;
            else
                passes = end - begin == 1;
        }
        if (!passes) std::fill(r.step.begin() + begin, r.step.begin() + end, 0.0);
    }
}

void check_wedges(const std::vector<Wedge>& wedges) {
    if (wedges.empty()) throw InputError("wedge_texcoord: the mesh has no wedge texture coordinates");
    for (std::size_t i = 0; i < wedges.size(); ++i)
        if (!(is_usable(wedges[i].u) && is_usable(wedges[i].v)))
            throw InputError("wedge_texcoord: the texture coordinate of corner " + std::to_string(i % 3) + " of face " +
                             std::to_string(i / 3) + " is not a finite number, or beyond 1e70");
}

void report_wedges(const CutMesh& cut, const Field& after, Report& report) {
    double largest = 0, squares = 0;
    for (Index n = 0; n < after.rows(); ++n) {
        const double u = after.row(n)[0] - cut.wedge[n].u, v = after.row(n)[1] - cut.wedge[n].v;
        largest = std::max(largest, u * u + v * v);
        squares += u * u + v * v;
    }
    const auto several = [&](Index begin, Index end) { return end - begin > 1; };
    int seam_vertices = 0;
    for (std::size_t v = 0; v + 1 < cut.nodes_of.size(); ++v)
        seam_vertices += several(cut.nodes_of[v], cut.nodes_of[v + 1]);
    report.add("wedge_texcoord_largest_change", std::sqrt(largest));
    report.add("wedge_texcoord_rms_change", after.rows() ? std::sqrt(squares / after.rows()) : 0.0);
    report.add("seam_vertices", seam_vertices);
}

std::vector<Wedge> relaxed_wedges(const Layer& layer, const AttributeRelaxationOptions& options,
                                  const std::vector<double>& weights, const Progress& progress, Report& report) {
    CutMesh cut = cut_along_seams(layer.mesh, layer.wedges);
    Field f(static_cast<Index>(cut.vertex.size()), 2);
    std::vector<double> node_weights(weights.empty() ? 0 : cut.vertex.size());
    for (Index n = 0; n < f.rows(); ++n) {
        f.row(n)[0] = cut.wedge[n].u;
        f.row(n)[1] = cut.wedge[n].v;
        if (!weights.empty()) node_weights[n] = weights[cut.vertex[n]];
    }
    Layer charts;
    charts.mesh = std::move(cut.mesh);
    charts.faux_edges = layer.faux_edges;
    charts.selected_edges = layer.selected_edges;
    Relaxation r = make_relaxation(charts, options, node_weights);
    if (options.keep_outline)
        r.step = inner_steps(r);
    else
        keep_seam_ends(r, cut);
    f = relaxed(r, r.step, std::move(f), options.iterations, progress);
    report_wedges(cut, f, report);
    std::vector<Wedge> out = layer.wedges;
    for (std::size_t c = 0; c < out.size(); ++c) {
        if (r.step[cut.node[c]] == 0) continue;
        out[c].u = f.row(cut.node[c])[0];
        out[c].v = f.row(cut.node[c])[1];
    }
    return out;
}

}  // namespace

Result relax_attributes(const Layer& layer, const AttributeRelaxationOptions& options, Session& session) {
    check(options);
    require_usable(layer.mesh);
    const std::vector<Channels> all = vertex_channels(layer, options.what, options.linear_light);
    if (options.what.wedge_texcoord) check_wedges(layer.wedges);
    const std::vector<double> weights = region_weights(layer, options.region);

    Result result;
    const double parts = static_cast<double>(all.size() + options.what.wedge_texcoord);
    const auto progress = [&](std::size_t i) {
        return session.progress.part(0.1 + 0.85 * static_cast<double>(i) / parts,
                                     0.1 + 0.85 * static_cast<double>(i + 1) / parts);
    };
    session.progress.report(0, "Computing weights");
    if (!all.empty()) {
        const Relaxation surface = make_relaxation(layer, options, weights);
        result.report.add("kept_vertices", count_kept(surface, weights));
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Channels& c = all[i];
            const bool inner = options.keep_outline && layer.attributes[c.attribute].kind == AttributeKind::texcoord;
            const Field after =
                relaxed(surface, inner ? inner_steps(surface) : surface.step, c.field, options.iterations, progress(i));
            result.attributes.push_back(changed_attribute(layer, c, after, {}, result.report));
        }
    }
    if (options.what.wedge_texcoord)
        result.wedges = relaxed_wedges(layer, options, weights, progress(all.size()), result.report);
    return result;
}

}  // namespace multires
