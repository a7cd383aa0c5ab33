#pragma once

#include "schemes/table.h"

#include "hierarchy_checks.h"
#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

/// What tests that run on every scheme of the table share.
namespace multires::fixtures {

/// The numbers of all rows of schemes().
inline std::vector<int> all_schemes() {
    std::vector<int> all(schemes().size());
    std::iota(all.begin(), all.end(), 0);
    return all;
}

inline bool takes_any_mesh(int scheme) { return !schemes()[static_cast<std::size_t>(scheme)].own_hierarchy; }

/// Of those that take any mesh.
inline std::vector<int> every_scheme() {
    std::vector<int> all = all_schemes();
    all.erase(std::remove_if(all.begin(), all.end(), [](int s) { return !takes_any_mesh(s); }), all.end());
    return all;
}

/// The mesh, or for a scheme of triangular grids a terrain of about as many vertices with a hole.
inline Mesh suited(int scheme, Mesh mesh) {
    if (takes_any_mesh(scheme)) return mesh;
    shapes::GridShape shape;
    shape.rows = static_cast<Index>(std::sqrt(0.8 * static_cast<double>(mesh.positions.size())));
    shape.columns = shape.rows * 5 / 4;
    shape.hole = 4;
    return shapes::grid_terrain(shape);
}

/// The hierarchy that a scheme takes.
/// @throws InputError  if the mesh is none for it
inline Hierarchy hierarchy_for(int scheme, const Mesh& mesh, const HierarchyOptions& options = {}) {
    const auto own = schemes()[static_cast<std::size_t>(scheme)].own_hierarchy;
    return own ? own(mesh, options) : hierarchy_of(mesh, options);
}

inline const Capabilities& can(int scheme) { return schemes()[static_cast<std::size_t>(scheme)].capabilities; }

/// A scheme's name as a part of a test's name.
inline std::string scheme_name(int scheme) { return schemes()[static_cast<std::size_t>(scheme)].name; }

}  // namespace multires::fixtures
