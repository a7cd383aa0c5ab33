#include "random.h"
#include "shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace multires::shapes {
namespace {

/// A ridge across, hills, and roughness, in cells.
double height(double x, double y, Random& random, double noise) {
    const double across = 0.8 * x - 0.6 * y - 4;
    return 3 * std::exp(-across * across / 8) + std::sin(0.31 * x + 0.2) * std::cos(0.23 * y) +
           noise * random.uniform(-1, 1);
}

}  // namespace

Mesh grid_terrain(const GridShape& shape) {
    Random random(shape.seed);
    Mesh mesh;
    std::vector<Index> number(static_cast<std::size_t>(shape.rows) * shape.columns, -1);
    const auto at = [&](Index i, Index j) -> Index& { return number[static_cast<std::size_t>(i) * shape.columns + j]; };
    const auto hole = [&](Index i, Index j) {  // a disk
        const double x = j - 0.6 * shape.columns, y = i - 0.4 * shape.rows;
        return x * x + y * y < shape.hole * shape.hole;
    };
    for (Index i = 0; i < shape.rows; ++i)
        for (Index j = 0; j < shape.columns; ++j) {
            if (hole(i, j) || (shape.triangle && i + j >= std::min(shape.rows, shape.columns))) continue;
            at(i, j) = static_cast<Index>(mesh.positions.size());
            mesh.positions.emplace_back(j, i, height(j, i, random, shape.noise));
        }
    for (Index i = 0; i + 1 < shape.rows; ++i)
        for (Index j = 0; j + 1 < shape.columns; ++j) {
            const bool second = shape.cut == GridCut::second || (shape.cut == GridCut::alternating && (i + j) % 2);
            const Index a = at(i, j), b = at(i, j + 1), c = at(i + 1, j + 1), d = at(i + 1, j);
            const std::array<Face, 2> halves = second ? std::array<Face, 2>{Face{a, b, d}, Face{b, c, d}}
                                                      : std::array<Face, 2>{Face{a, b, c}, {a, c, d}};
            for (const Face& f : halves)
                if (std::min({f[0], f[1], f[2]}) >= 0 && !random.chance(shape.missing)) mesh.faces.push_back(f);
        }
    return mesh;
}

}  // namespace multires::shapes
