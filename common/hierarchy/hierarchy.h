#pragma once

#include "mesh/mesh.h"
#include "mesh/rings.h"

#include <functional>
#include <vector>

namespace multires {

/// How collapses are grouped into levels.
enum class Grouping {
    /// A maximal independent set of vertices per step: no two removed vertices are neighbours (Roy et al. 2003,
    /// section 3.1). A level is `sets_per_level` such steps.
    independent_sets,
    /// One vertex at a time, cheapest first (Guskov et al. 1999, section 3). A level is one vertex, or as many as
    /// `level_ratio` says.
    sequential,
};

/// Which vertices go first, and into which neighbour.
enum class Split {
    quadric,  ///< those of the least cost (Garland and Heckbert 1997), see HierarchyOptions::length_weight
    /// Those nearest to the plane that fits their ring best; on boundaries and creases, to the line through their two
    /// neighbours. Into the neighbour for which the sum of 1 - cos of the turns of the faces is least (Szczesna 2011,
    /// eq. 14). Distances are not relative to anything: flat parts go first.
    regression_plane,
};

/// What to build a hierarchy for. All lengths follow the mesh: nothing here depends on its scale.
struct HierarchyOptions {
    Grouping grouping = Grouping::independent_sets;
    int sets_per_level = 1;  ///< >= 1; each set removes 22 to 25 % of the vertices
    double set_share = 1;   ///< independent sets: each takes only from this cheapest share of its candidates, in (0, 1]
    int valence_power = 0;  ///< independent sets: costs times (valence / 6) to this power, >= 0; 3 keeps hubs for later
    bool memoryless = false;     ///< independent sets: costs from the faces as they are, not summed since the input
                                 ///< (Lindstrom and Turk 1998): less error for the same number of vertices
    double boundary_weight = 1;  ///< independent sets, > 0: of the planes that stand on the boundary
    double level_ratio = 0;      ///< in [0, 1): a level keeps this share of its vertices; 0: one vertex per level
    Index base_vertices = 100;  ///< stop here (and at Hierarchy::beside), or earlier if no collapse is allowed any more
    double normal_limit_degrees = 60;  ///< a collapse may turn no face normal by more than this, in (0, 180]
    /// Weight of the edge-length term beside the quadric: cost = (Q_v + Q_u)(p_u) + weight * area_v * |p_v - p_u|^2.
    /// 0: quadric only (Roy); larger values keep vertices of a level evenly spaced, which sharpens bands. With any, and
    /// independent sets that are not memoryless, vertices of the boundary stay while its edges are longer than 1.5
    /// times those from there into the surface, and its corners (mesh/corner.h) that point outwards stay.
    double length_weight = 0.1;
    Split split = Split::quadric;
    int seed = 0;             ///< other than 0: costs vary at random by up to half, for another hierarchy
    bool flaps = true;        ///< store Rings::flap, for operators that need the 1-ring with flaps
    bool even_rings = true;   ///< fill Hierarchy::even
    bool mean_edges = false;  ///< independent sets: fill Hierarchy::mean_edge
};

/// Rows begin..end-1 of some Rings.
struct RowRange {
    Index begin = 0, end = 0;
    Index size() const { return end - begin; }
};

/// One level: between the mesh of `fine` vertices and that of `coarse` vertices. There may be as many levels as
/// vertices, so what is long is in tables that all of them share.
///
/// A vertex's place is its number in hierarchy order: 0..coarse-1 are even (they stay), coarse..fine-1 odd (removed).
struct Level {
    Index fine = 0, coarse = 0;
    RowRange odd;  ///< of Hierarchy::odd: those of the places coarse..fine-1
    /// Where the sets of odd rows begin that follow the first. Entries and flaps of a row are even or belong to sets
    /// before its own, so the rows of a set can be predicted in any order.
    std::vector<Index> cuts;

    std::size_t sets() const { return cuts.size() + 1; }
    RowRange set(std::size_t s) const {
        return {s == 0 ? odd.begin : cuts[s - 1], s == cuts.size() ? odd.end : cuts[s]};
    }
    /// True if all entries and flaps of odd rows are even.
    bool independent() const { return cuts.empty(); }
};

/// Where on a triangular grid a vertex lies.
struct LatticePlace {
    Index grid = -1;  ///< which one, largest first; -1: in none
    Index i = 0, j = 0;
};

/// The order in which half-edge collapses remove vertices, grouped into levels. Knows geometry, not signals: positions
/// never move, so every level is a subset of the input's vertices.
struct Hierarchy {
    Array<Index> order;         ///< #V: order[place] = input vertex; level k is the prefix of size[k] places
    Array<Index> parent;        ///< #V: place the vertex was collapsed into, smaller than its own; -1 in the base
    std::vector<Index> size;    ///< #levels+1: vertices of level k, size[0] = #V, the last is the base
    std::vector<Level> levels;  ///< levels[k] leads from size[k] to size[k+1] vertices; 0 is the finest
    /// #V - size.back(), from the coarsest level's to the finest one's: rings of vertices at the moment they are
    /// removed, in places. All entries of a row are smaller than its own place, Rings::vertex(row). See Level::odd.
    Rings odd;
    /// #levels, or empty without HierarchyOptions::even_rings: rings, in the mesh of the level's `fine` vertices, of
    /// its even vertices (Rings::vertices): all of them in order of the input, which is kind to caches where places
    /// are not; or, with one vertex per level, only those next to the odd vertex.
    std::vector<Rings> even;
    Rings base;           ///< rings of the base's vertices (row i = place i)
    Positions positions;  ///< #V: positions in order of places
    /// #levels+1: mean edge lengths of the levels' meshes, an edge on the boundary counting as any other; mesh units.
    /// Empty unless asked for.
    std::vector<double> mean_edge;
    Array<LatticePlace> lattice;  ///< #V, or empty: the hierarchy is not that of triangular grids
    Index irregular = 0;          ///< vertices kept because their neighbourhood is not a disk or half disk
    Index isolated = 0;           ///< vertices kept because no face holds them
    Index beside = 0;  ///< vertices kept for parts beside the largest one: four for each, or three if it has no more

    Index vertices() const { return static_cast<Index>(order.size()); }
};

/// Called now and then with the fraction done; may throw to stop.
using Tick = std::function<void(double)>;

/// Builds the hierarchy of a mesh by half-edge collapses v -> u in the order that Split says, grouped as the
/// options say.
///
/// A collapse is allowed if the link condition holds in the mesh as it is at that moment, no normal turns by more
/// than the limit, and no face becomes degenerate or much worse shaped. Boundary vertices go only along the
/// boundary, vertices with two feature edges only along the feature; irregular and isolated vertices and feature
/// corners stay. The result does not depend on the number of threads.
///
/// @param rings      vertex_rings() of the mesh, with features marked if wanted; consumed
/// @param positions  #V by 3, finite
/// Cost: linear in #V (independent sets), O(#V log #V) (sequential).
Hierarchy build_hierarchy(Rings rings, const Positions& positions, const HierarchyOptions& options,
                          const Tick& tick = {});

/// The mesh of a level: faces over places 0..size[level]-1, and which input face each comes from.
struct LevelMesh {
    Faces faces;
    std::vector<Index> source_face;
};

/// Where every place has gone once only some are left: to its nearest ancestor that stays.
/// @param stays  bool(Index place), true for the base
template <class Stays>
Array<Index> places_left(const Hierarchy& h, const Stays& stays) {
    Array<Index> gone_to(h.vertices());  // parents come before their children
    for (Index p = 0; p < h.vertices(); ++p) gone_to[p] = stays(p) ? p : gone_to[h.parent[p]];
    return gone_to;
}

/// The mesh over the places left, in order of the input: faces that lose a corner are dropped. Faces of the input that
/// repeat an index stay if all their vertices do, so that with all places it is the input.
/// @param faces     those the rings came from, with input vertex indices
/// @param gone_to   #V, see places_left()
LevelMesh mesh_of_places(const Hierarchy& hierarchy, const Faces& faces, const Array<Index>& gone_to);

/// @param level  0 (the input) .. levels.size() (the base)
LevelMesh level_mesh(const Hierarchy& hierarchy, const Faces& faces, std::size_t level);

/// The mesh of the first `count` places, count >= the base's size.
LevelMesh prefix_mesh(const Hierarchy& hierarchy, const Faces& faces, Index count);

/// Memory a hierarchy holds, in bytes.
std::size_t bytes(const Hierarchy& hierarchy);

}  // namespace multires
