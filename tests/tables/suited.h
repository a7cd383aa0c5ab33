#pragma once

#include "given.h"
#include "random.h"
#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace multires::plugin {

/// The mesh if the filter takes any; a terrain of about as many vertices for filters of triangular grids.
inline Mesh suited(const Filter& filter, Mesh mesh) {
    if (!wants_grid(filter)) return mesh;
    shapes::GridShape shape;
    shape.rows = std::max<Index>(5, static_cast<Index>(std::sqrt(0.8 * static_cast<double>(mesh.positions.size()))));
    shape.columns = shape.rows * 5 / 4;
    shape.hole = 0.1 * shape.rows;
    return shapes::grid_terrain(shape);
}

/// A small grid, with faces missing, and one time in four damaged like damaged_mesh().
inline Mesh random_grid(std::uint64_t seed) {
    shapes::Random random(seed);
    shapes::GridShape shape;
    shape.rows = 2 + static_cast<Index>(random.bits() % 14), shape.columns = 2 + static_cast<Index>(random.bits() % 14);
    shape.cut = random.chance(0.5) ? shapes::GridCut::first : shapes::GridCut::second;
    shape.triangle = random.chance(0.2), shape.missing = random.chance(0.5) ? 0.1 : 0, shape.seed = seed;
    Mesh mesh = shapes::grid_terrain(shape);
    if (mesh.faces.empty()) mesh.faces.push_back({0, 1, 2});
    const auto any = [&] { return static_cast<Index>(random.bits() % mesh.positions.size()); };
    if (random.chance(0.25)) mesh.faces.push_back({any(), any(), any()});
    return mesh;
}

}  // namespace multires::plugin
