#pragma once

#include "hierarchy/hierarchy.h"

namespace multires {

/// Where simplification ends: at the vertices, or at the first step at which there are as few faces.
struct SimplifyGoal {
    Index vertices = 0;  ///< of those in faces; isolated ones stay
    Index faces = 0;
};

/// A mesh of some of the input's vertices, moved. Vertices and faces are in order of the input.
struct Simplified {
    std::vector<Index> source_vertex, source_face;
    std::vector<Index> into;  ///< #V of the input: the vertex each went into, or is
    Faces faces;
    Positions positions;
};

/// Half-edge collapses in independent sets, as build_hierarchy() does them with Split::quadric, in which the vertex
/// that stays moves to where it fits the faces that were there best (see move_vertices()). Boundary, features
/// and what is not manifold stay where they are. No face is turned over by a move. The result does not depend on the
/// number of threads.
/// @param options  normal_limit_degrees, set_share, boundary_weight and seed count
/// @return as few vertices and faces as either goal says; or more: if all collapses of the cheapest set_share are
///         barred at some step, others would cost more than they should, and another order does better
/// Cost: linear in #V.
Simplified simplify(const Mesh& mesh, Rings rings, const HierarchyOptions& options, const SimplifyGoal& goal,
                    const Tick& tick = {});

}  // namespace multires
