#include "schemes/lattice_hierarchy.h"

#include "base/error.h"
#include "grids/grid_pyramid.h"

#include <array>
#include <cstdint>
#include <string>
#include <utility>

namespace multires {
namespace {

using Vertices = RasterOf<Index>;  // of a level: the vertex that stands for each cell, -1 for none

/// A vertex that goes, and the one it goes into.
struct Step {
    Index from, to;
};

/// Halves the cells; the vertices of the diagonal come last, so that they go first.
Vertices coarser(const Vertices& fine, std::vector<Step>& steps) {
    constexpr std::array<std::array<Index, 2>, 4> children{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}};
    Vertices coarse((fine.rows + 1) / 2, (fine.columns + 1) / 2, -1);
    std::vector<Step> diagonal;
    for (Index i = 0; i < coarse.rows; ++i)
        for (Index j = 0; j < coarse.columns; ++j)
            for (const auto& c : children) {
                const Index x = 2 * i + c[0], y = 2 * j + c[1];
                const Index v = x < fine.rows && y < fine.columns ? fine.row(x)[y] : -1;
                Index& stays = coarse.row(i)[j];
                if (v < 0) continue;
                if (stays < 0)
                    stays = v;
                else
                    (c[0] == c[1] ? diagonal : steps).push_back({v, stays});
            }
    steps.insert(steps.end(), diagonal.begin(), diagonal.end());
    return coarse;
}

FoundGrids found_in(const Mesh& mesh) {
    try {
        return find_grids(mesh.faces, static_cast<Index>(mesh.positions.size()));
    } catch (const InputError& e) {
        throw InputError(std::string("scheme: Dreger is for triangular grids; ") + e.what());
    }
}

/// Up to 7 points along each direction, by the seed.
std::array<Index, 2> shift_of(int seed) {
    const std::uint32_t mixed = static_cast<std::uint32_t>(seed) * 0x9e3779b9u;
    return {static_cast<Index>(mixed >> 29), static_cast<Index>(mixed >> 26 & 7u)};
}

Vertices shifted(const Grid& grid, const std::array<Index, 2>& by) {
    Vertices out(grid.rows + by[0], grid.columns + by[1], -1);
    for (Index i = 0; i < grid.rows; ++i)
        for (Index j = 0; j < grid.columns; ++j)
            out.row(i + by[0])[j + by[1]] = grid.vertex[static_cast<std::size_t>(i) * grid.columns + j];
    return out;
}

Index count(const std::vector<Vertices>& grids) {
    Index n = 0;
    for (const Vertices& grid : grids)
        for (const Index v : grid.values) n += v >= 0;
    return n;
}

Array<LatticePlace> lattice_of(const std::vector<Vertices>& grids, std::size_t vertices) {
    Array<LatticePlace> lattice(vertices);
    for (std::size_t g = 0; g < grids.size(); ++g)
        for (Index i = 0; i < grids[g].rows; ++i)
            for (Index j = 0; j < grids[g].columns; ++j)
                if (const Index v = grids[g].row(i)[j]; v >= 0) lattice[v] = {static_cast<Index>(g), i, j};
    return lattice;
}

Rings no_rings(Index first, Index rows) {
    Rings rings;
    rings.first = first;
    rings.offset.assign(rows + 1, 0);
    rings.kind.assign(rows, RingKind::isolated);
    return rings;
}

/// Numbers the places: those in no grid, those of the coarsest level, and those that go, coarsest level first.
void number(const std::vector<Vertices>& coarsest, const std::vector<std::vector<Step>>& steps,
            const Array<LatticePlace>& lattice, Hierarchy& h) {
    for (Index v = 0; v < static_cast<Index>(lattice.size()); ++v)
        if (lattice[v].grid < 0) h.order.push_back(v);
    for (const Vertices& grid : coarsest)
        for (const Index v : grid.values)
            if (v >= 0) h.order.push_back(v);
    h.size.assign(1, static_cast<Index>(h.order.size()));
    for (std::size_t k = steps.size(); k-- > 0;) {
        for (const Step& s : steps[k]) h.order.push_back(s.from);
        h.size.insert(h.size.begin(), static_cast<Index>(h.order.size()));
    }
    Array<Index> place(h.order.size());
    for (Index p = 0; p < h.vertices(); ++p) place[h.order[p]] = p;
    h.parent.assign(h.order.size(), -1);
    for (const std::vector<Step>& level : steps)
        for (const Step& s : level) h.parent[place[s.from]] = place[s.to];
}

Index isolated_vertices(const Mesh& mesh) {
    std::vector<std::uint8_t> used(mesh.positions.size(), 0);
    for (const Face& f : mesh.faces)
        if (f[0] != f[1] && f[1] != f[2] && f[2] != f[0])
            for (const Index v : f) used[v] = 1;
    Index n = 0;
    for (const std::uint8_t u : used) n += !u;
    return n;
}

}  // namespace

Hierarchy lattice_hierarchy(const Mesh& mesh, const HierarchyOptions& options) {
    const FoundGrids found = found_in(mesh);
    std::vector<Vertices> grids;
    for (const Grid& grid : found.grids)
        grids.push_back(shifted(grid, options.seed == 0 ? std::array<Index, 2>{0, 0} : shift_of(options.seed)));
    Hierarchy h;
    const Array<LatticePlace> lattice = lattice_of(grids, mesh.positions.size());
    std::vector<std::vector<Step>> steps;
    const int most = usual_levels(found.grids[0]);
    for (Index left = count(grids); left > options.base_vertices && static_cast<int>(steps.size()) < most;) {
        steps.emplace_back();
        for (Vertices& grid : grids) grid = coarser(grid, steps.back());
        left -= static_cast<Index>(steps.back().size());
    }
    number(grids, steps, lattice, h);
    h.isolated = isolated_vertices(mesh);
    h.irregular = found.loose_vertices;
    for (std::size_t k = 0; k + 1 < h.size.size(); ++k) {
        Level level;
        level.fine = h.size[k], level.coarse = h.size[k + 1];
        level.odd = {level.coarse - h.size.back(), level.fine - h.size.back()};
        h.levels.push_back(std::move(level));
    }
    h.odd = no_rings(h.size.back(), h.size.front() - h.size.back());
    h.base = no_rings(0, h.size.back());
    for (const Index v : h.order) {
        h.positions.push_back(mesh.positions[v]);
        h.lattice.push_back(lattice[v]);
    }
    return h;
}

}  // namespace multires
