#include "hierarchy/hierarchy.h"

#include "hierarchy/independent_sets.h"
#include "hierarchy/renumber.h"
#include "hierarchy/sequential.h"
#include "mesh/adjacency.h"
#include "parallel/parallel.h"

#include <algorithm>

namespace multires {
namespace {

/// Scales about the box's centre to a box of diagonal 1, so that costs neither overflow nor underflow and do not
/// depend on where the mesh lies.
Positions normalised(const Positions& positions) {
    Vec3 lo = positions.empty() ? Vec3(0, 0, 0) : positions[0], hi = lo;
    for (const Vec3& p : positions) lo = lo.cwiseMin(p), hi = hi.cwiseMax(p);
    const Vec3 centre = lo + (hi - lo) / 2;
    const double diagonal = (hi - lo).norm(), scale = diagonal > 0 ? 1 / diagonal : 1;
    Positions out(positions.size());
    parallel_for(static_cast<Index>(positions.size()), [&](Index i) { out[i] = (positions[i] - centre) * scale; });
    return out;
}

/// Places of a step's local vertices, and back.
struct Numbering {
    std::vector<Index> place, local;
};

Numbering number_step(const Step& step, const Numbering& coarser) {
    const Index n = static_cast<Index>(step.parent.size()), even = n - step.odd;
    Numbering numbering;
    numbering.place.resize(n);
    numbering.local.resize(n);
    for (Index i = 0; i < n; ++i) {
        const Index place = step.parent[i] < 0 ? coarser.place[step.rank[i]] : even + step.rank[i];
        numbering.place[i] = place;
        numbering.local[place] = i;
    }
    return numbering;
}

std::vector<Index> slice(const std::vector<Index>& v, Index begin, Index end) {
    return {v.begin() + begin, v.begin() + end};
}

/// Turns steps into levels of `sets_per_level` steps, numbered so that every level is a prefix.
Hierarchy assemble(std::vector<Step> steps, const HierarchyOptions& options) {
    Hierarchy h;
    const int count = static_cast<int>(steps.size()) - 1;  // the last one is the base
    std::vector<Numbering> numbering(steps.size());
    const Index base = steps.back().rings.rows();
    numbering.back().place.resize(base);
    for (Index i = 0; i < base; ++i) numbering.back().place[i] = i;
    numbering.back().local = numbering.back().place;
    for (int s = count - 1; s >= 0; --s) numbering[s] = number_step(steps[s], numbering[s + 1]);

    h.order = numbering[0].local;
    h.parent.assign(h.order.size(), -1);
    for (int s = 0; s < count; ++s) {
        const Numbering& at = numbering[s];
        for (std::size_t i = 0; i < steps[s].parent.size(); ++i)
            if (steps[s].parent[i] >= 0) h.parent[at.place[i]] = at.place[steps[s].parent[i]];
    }
    if (options.flaps)
        for (Step& step : steps) find_flaps(step.rings);

    h.size.push_back(steps[0].rings.rows());
    for (int first = 0; first < count; first += options.sets_per_level) {
        const int last = std::min(first + options.sets_per_level, count);
        Level level;
        level.fine = steps[first].rings.rows();
        level.coarse = steps[last].rings.rows();
        level.independent = last == first + 1;
        level.even = renumbered(steps[first].rings, slice(numbering[first].local, 0, level.coarse),
                                numbering[first].place, level.fine);
        for (int s = last - 1; s >= first; --s) {  // the vertices removed last are inserted first
            const Index fine = steps[s].rings.rows(), even = fine - steps[s].odd;
            append(level.odd,
                   renumbered(steps[s].rings, slice(numbering[s].local, even, fine), numbering[s].place, even));
        }
        level.odd.first = level.coarse;
        h.size.push_back(level.coarse);
        h.levels.push_back(std::move(level));
        for (int s = first; s < last; ++s) steps[s] = Step(), numbering[s] = Numbering();
    }
    h.base = std::move(steps.back().rings);
    return h;
}

}  // namespace

Hierarchy build_hierarchy(Rings rings, const Positions& positions, const HierarchyOptions& options, const Tick& tick) {
    const Index irregular = static_cast<Index>(std::count(rings.kind.begin(), rings.kind.end(), RingKind::irregular));
    const Index isolated = static_cast<Index>(std::count(rings.kind.begin(), rings.kind.end(), RingKind::isolated));
    Hierarchy h = options.grouping == Grouping::independent_sets
                      ? assemble(independent_sets(std::move(rings), normalised(positions), options, tick), options)
                      : sequential(rings, normalised(positions), options, tick);
    h.irregular = irregular;
    h.isolated = isolated;
    h.positions.resize(positions.size());
    parallel_for(h.vertices(), [&](Index place) { h.positions[place] = positions[h.order[place]]; });
    return h;
}

LevelMesh prefix_mesh(const Hierarchy& h, const Faces& faces, Index count) {
    // Where a vertex has gone once only `count` places are left; parents come before their children.
    std::vector<Index> gone_to(h.vertices());
    for (Index p = 0; p < h.vertices(); ++p) gone_to[p] = p < count ? p : gone_to[h.parent[p]];
    std::vector<Index> of_input(h.vertices());
    for (Index p = 0; p < h.vertices(); ++p) of_input[h.order[p]] = gone_to[p];
    LevelMesh mesh;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const Face g = {of_input[faces[f][0]], of_input[faces[f][1]], of_input[faces[f][2]]};
        if (g[0] == g[1] || g[1] == g[2] || g[2] == g[0]) continue;
        mesh.faces.push_back(g);
        mesh.source_face.push_back(static_cast<Index>(f));
    }
    return mesh;
}

LevelMesh level_mesh(const Hierarchy& h, const Faces& faces, std::size_t level) {
    return prefix_mesh(h, faces, h.size[level]);
}

}  // namespace multires
