#include "hierarchy/hierarchy.h"

#include "base/parallel.h"
#include "base/reduce.h"
#include "hierarchy/independent_sets.h"
#include "hierarchy/parts.h"
#include "hierarchy/renumber.h"
#include "hierarchy/sequential.h"
#include "hierarchy/simplify.h"
#include "mesh/adjacency.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace multires {
namespace {

/// The positions about the box's centre in a box of diagonal 1, so that costs neither overflow nor underflow and do not
/// depend on where the mesh lies.
struct Normalised {
    Positions positions;
    double diagonal = 1;  ///< of the mesh's box; 1 if that is a point
    Vec3 centre{0, 0, 0};

    explicit Normalised(const Positions& input) : positions(input.size()) {
        Vec3 lo = input.empty() ? Vec3(0, 0, 0) : input[0], hi = lo;
        for (const Vec3& p : input) lo = lo.cwiseMin(p), hi = hi.cwiseMax(p);
        centre = lo + (hi - lo) / 2;
        if ((hi - lo).norm() > 0) diagonal = (hi - lo).norm();
        parallel_for(static_cast<Index>(input.size()), [&](Index i) { positions[i] = normalised(input[i]); });
    }

    Vec3 normalised(const Vec3& p) const { return (p - centre) * (1 / diagonal); }

    /// The point of the input at a normalised one: `before`, bit for bit, if it was never moved.
    Vec3 unless_still(const Vec3& before, const Vec3& now) const {
        return now == normalised(before) ? before : Vec3(now * diagonal + centre);
    }
};

/// Places of a step's local vertices: odd vertices come after all even ones.
Array<Index> places_of(const Step& step, const Array<Index>& coarser) {
    const Index n = step.rings.rows(), even = n - static_cast<Index>(step.parent.size());
    Array<Index> place(n);
    parallel_for(n, [&](Index i) { place[i] = step.code[i] >= 0 ? coarser[step.code[i]] : even + ~step.code[i]; });
    return place;
}

/// Local vertices with places in [begin, end), in local order. That order runs along the surface if the input's does,
/// so rows in it find their neighbours near each other.
Array<Index> rows_between(const Array<Index>& place, Index begin, Index end) {
    const auto size = static_cast<std::size_t>(end - begin);
    Array<Index> rows(size);
    const auto in = [&](Index i) {
        return static_cast<std::size_t>(place[i]) - static_cast<std::size_t>(begin) < size;
    };
    ranked_for(static_cast<Index>(place.size()), in, [&](Index i, Index rank) {
        Index nowhere;  // which are in is hard to predict: no branch
        *(in(i) ? &rows[rank] : &nowhere) = i;
    });
    return rows;
}

/// Room for the rings of all vertices that steps remove, with offsets.
Rings room_for_odd(const std::vector<Step>& steps, const HierarchyOptions& options) {
    Rings odd;
    odd.first = steps.back().rings.rows();
    const Index rows = steps[0].rings.rows() - odd.first;
    odd.kind.resize(rows);
    odd.offset.resize(rows + 1);
    odd.offset[0] = 0;
    for (const Step& step : steps) {
        const Index n = step.rings.rows(), even = n - static_cast<Index>(step.parent.size());
        parallel_for(n, [&](Index i) {
            if (step.code[i] < 0) odd.offset[even + ~step.code[i] - odd.first + 1] = step.rings.size(i);
        });
    }
    add_up(odd.offset);
    odd.neighbor.resize(odd.offset.back());
    if (options.flaps) odd.flap.resize(odd.neighbor.size());
    if (!steps[0].rings.feature.empty()) odd.feature.resize(odd.neighbor.size());
    return odd;
}

/// Rings of the places 0..coarse-1 in order of the step's vertices.
Rings even_rings(const Rings& rings, const Array<Index>& place, Index coarse, bool flaps) {
    const Array<Index> rows = rows_between(place, 0, coarse);
    Rings even = renumbered(rings, rows, place, rings.rows(), flaps);
    even.vertices.resize(rows.size());
    parallel_for(even.rows(), [&](Index r) { even.vertices[r] = place[rows[r]]; });
    return even;
}

/// Turns steps into levels of `sets_per_level` steps, numbered so that every level is a prefix.
Hierarchy assemble(std::vector<Step> steps, const HierarchyOptions& options) {
    Hierarchy h;
    const int count = static_cast<int>(steps.size()) - 1;  // the last one is the base
    std::vector<Array<Index>> place(steps.size());
    place.back() = steps.back().code;
    for (int s = count - 1; s >= 0; --s) place[s] = places_of(steps[s], place[s + 1]);

    const Index n = steps[0].rings.rows(), base = steps.back().rings.rows();
    h.order.resize(n);
    parallel_for(n, [&](Index i) { h.order[place[0][i]] = i; });
    h.parent.assign(n, -1);
    h.size.push_back(n);
    h.odd = room_for_odd(steps, options);
    for (int first = 0; first < count; first += options.sets_per_level) {
        const int last = std::min(first + options.sets_per_level, count);
        Level level;
        level.fine = steps[first].rings.rows();
        level.coarse = steps[last].rings.rows();
        level.odd = {level.coarse - base, level.fine - base};
        for (int s = last - 1; s >= first; --s) {  // the vertices removed last are inserted first
            Step& step = steps[s];
            const Index fine = step.rings.rows(), even = fine - static_cast<Index>(step.parent.size());
            const Array<Index> odd = rows_between(place[s], even, fine);
            parallel_for(fine - even, [&](Index i) { h.parent[even + i] = place[s][step.parent[i]]; });
            renumber_into(h.odd, even - base, step.rings, odd, place[s], even);
            if (s > first) level.cuts.push_back(fine - base);
        }
        if (options.mean_edges) h.mean_edge.push_back(steps[first].mean_edge);
        if (options.even_rings)
            h.even.push_back(even_rings(steps[first].rings, place[first], level.coarse, options.flaps));
        h.size.push_back(level.coarse);
        h.levels.push_back(std::move(level));
        for (int s = first; s < last; ++s) steps[s] = Step(), place[s] = Array<Index>();
    }
    if (options.flaps) find_flaps(steps.back().rings);
    h.base = std::move(steps.back().rings);
    if (options.mean_edges) h.mean_edge.push_back(steps.back().mean_edge);
    return h;
}

/// True if many neighbours lie too far apart in memory to share a cache.
bool jumps_about(const Rings& rings) {
    const Index n = rings.rows();
    const Index near = std::max<Index>(2048, static_cast<Index>(2 * std::sqrt(static_cast<double>(n))));
    if (n <= 2 * near) return false;
    const auto far = chunked_fold<std::int64_t>(n, [&](std::int64_t& count, std::size_t row) {
        const Index i = static_cast<Index>(row);
        for (Index j = 0; j < rings.size(i); ++j) count += std::abs(rings.begin(i)[j] - i) > near;
    });
    return 10 * far > static_cast<std::int64_t>(rings.neighbor.size());
}

/// Puts the vertices into an order that is kind to caches, if theirs is not.
/// @return order[new number] = number of the input; empty: nothing was done
Array<Index> sort_for_caches(Rings& rings, Positions& positions) {
    if (!jumps_about(rings)) return {};
    Array<Index> order = breadth_first_order(rings);
    const Index n = rings.rows();
    Array<Index> place(n);
    Positions moved(n);
    parallel_for(n, [&](Index i) {
        place[order[i]] = i;
        moved[i] = positions[order[i]];
    });
    positions = std::move(moved);
    rings = renumbered(rings, order, place, n, false);
    return order;
}

/// independent_sets() and assemble(), in an order of vertices that is kind to caches.
Hierarchy by_sets(Rings rings, Positions positions, const HierarchyOptions& options, const Tick& tick) {
    const Array<Index> order = sort_for_caches(rings, positions);
    Hierarchy h = assemble(independent_sets(std::move(rings), std::move(positions), options, tick), options);
    if (!order.empty())
        for (Index& v : h.order) v = order[v];
    return h;
}

/// Which of the vertices left after the last step each one is, or ~ which it has gone to.
Array<Index> what_became(const std::vector<Step>& steps) {
    Array<Index> now = steps.back().code;
    for (std::size_t s = steps.size() - 1; s-- > 0;) {
        const Step& step = steps[s];
        const Array<Index> after = std::move(now);
        now = Array<Index>(step.code.size());
        parallel_for(static_cast<Index>(now.size()), [&](Index i) {
            const Index code = step.code[i];
            const Index to = after[code >= 0 ? code : step.code[step.parent[~code]]];
            now[i] = code < 0 && to >= 0 ? ~to : to;
        });
    }
    return now;
}

/// Faces between what their corners became, without those that a collapse left without an area.
/// @param became  Index(Index vertex): the index of what is there now
/// @param gone    bool(Index vertex): it went into another
template <class Became, class Gone>
void take_faces(const Faces& faces, const Became& became, const Gone& gone, Faces& left, std::vector<Index>& source) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const Face& was = faces[f];
        const Face g = {became(was[0]), became(was[1]), became(was[2])};
        const bool degenerate = g[0] == g[1] || g[1] == g[2] || g[2] == g[0];
        if (degenerate && (gone(was[0]) || gone(was[1]) || gone(was[2]))) continue;
        left.push_back(g);
        source.push_back(static_cast<Index>(f));
    }
}

/// The mesh of what is left.
/// @param became  #V of the input, see what_became()
/// @param left    their positions
Simplified mesh_of_rest(const Mesh& mesh, const Array<Index>& became, const Normalised& left) {
    Simplified out;
    Array<Index> index(left.positions.size());
    for (std::size_t v = 0; v < became.size(); ++v) {
        if (became[v] < 0) continue;
        index[became[v]] = static_cast<Index>(out.source_vertex.size());
        out.source_vertex.push_back(static_cast<Index>(v));
        out.positions.push_back(left.unless_still(mesh.positions[v], left.positions[became[v]]));
    }
    out.into.resize(became.size());
    for (std::size_t v = 0; v < became.size(); ++v) out.into[v] = index[became[v] >= 0 ? became[v] : ~became[v]];
    const auto corner = [&](Index v) { return out.into[v]; };
    take_faces(
        mesh.faces, corner, [&](Index v) { return became[v] < 0; }, out.faces, out.source_face);
    return out;
}

/// See Hierarchy::beside.
Index vertices_beside(const Rings& rings) {
    Array<Index> size(rings.rows(), 0);  // of the part of which a vertex is the least
    for (const Index part : parts_of(rings)) ++size[part];
    Index sum = 0, largest = 0;
    for (const Index vertices : size) {
        if (vertices > 1) sum += std::min<Index>(vertices, 4);
        largest = std::max(largest, vertices);
    }
    return std::max<Index>(0, sum - std::min<Index>(largest, 4));
}

}  // namespace

Hierarchy build_hierarchy(Rings rings, const Positions& positions, const HierarchyOptions& options, const Tick& tick) {
    const Index beside = vertices_beside(rings);
    HierarchyOptions with_parts = options;
    with_parts.base_vertices = std::min(options.base_vertices, rings.rows()) + beside;
    const Index irregular = static_cast<Index>(std::count(rings.kind.begin(), rings.kind.end(), RingKind::irregular));
    const Index isolated = static_cast<Index>(std::count(rings.kind.begin(), rings.kind.end(), RingKind::isolated));
    Normalised normalised(positions);
    Hierarchy h = options.grouping == Grouping::independent_sets
                      ? by_sets(std::move(rings), std::move(normalised.positions), with_parts, tick)
                      : sequential(rings, normalised.positions, with_parts, tick);
    for (double& length : h.mean_edge) length *= normalised.diagonal;
    h.irregular = irregular;
    h.isolated = isolated;
    h.beside = beside;
    h.positions.resize(positions.size());
    parallel_for(h.vertices(), [&](Index place) { h.positions[place] = positions[h.order[place]]; });
    return h;
}

Simplified simplify(const Mesh& mesh, Rings rings, const HierarchyOptions& options, const SimplifyGoal& goal,
                    const Tick& tick) {
    HierarchyOptions o = options;
    o.memoryless = true;
    o.length_weight = 0;
    o.split = Split::quadric;
    o.mean_edges = false;
    o.base_vertices = goal.vertices;
    Normalised normalised(mesh.positions);
    const Array<Index> order = sort_for_caches(rings, normalised.positions);
    const std::vector<Step> steps =
        moving_sets(std::move(rings), normalised.positions, o, static_cast<Index>(mesh.faces.size()), goal.faces, tick);
    const Array<Index> local = what_became(steps);
    Array<Index> became = local;
    for (std::size_t i = 0; i < order.size(); ++i) became[order[i]] = local[i];
    return mesh_of_rest(mesh, became, normalised);
}

LevelMesh mesh_of_places(const Hierarchy& h, const Faces& faces, const Array<Index>& gone_to) {
    Array<Index> of_input(h.vertices());
    parallel_for(h.vertices(), [&](Index p) { of_input[h.order[p]] = gone_to[p]; });
    LevelMesh mesh;
    const auto became = [&](Index v) { return of_input[v]; };
    take_faces(
        faces, became, [&](Index v) { return h.order[of_input[v]] != v; }, mesh.faces, mesh.source_face);
    return mesh;
}

LevelMesh prefix_mesh(const Hierarchy& h, const Faces& faces, Index count) {
    return mesh_of_places(h, faces, places_left(h, [&](Index place) { return place < count; }));
}

LevelMesh level_mesh(const Hierarchy& h, const Faces& faces, std::size_t level) {
    return prefix_mesh(h, faces, h.size[level]);
}

std::size_t bytes(const Hierarchy& h) {
    const auto of = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
    const auto of_rings = [&](const Rings& r) {
        return of(r.offset) + of(r.neighbor) + of(r.flap) + of(r.feature) + of(r.kind) + of(r.vertices);
    };
    std::size_t sum = of(h.order) + of(h.parent) + of(h.size) + of(h.levels) + of_rings(h.odd) + of(h.even) +
                      of(h.positions) + of(h.mean_edge) + of(h.lattice) + of_rings(h.base);
    for (const Level& level : h.levels) sum += of(level.cuts);
    for (const Rings& even : h.even) sum += of_rings(even);
    return sum;
}

}  // namespace multires
