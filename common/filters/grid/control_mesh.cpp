#include "filters/grid/control_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace multires {
namespace {

/// Numbers points as faces ask for them.
class Builder {
public:
    Builder(Index rows, Index columns, bool reversed)
        : columns_(columns), reversed_(reversed), number_(static_cast<std::size_t>(rows) * columns, -1) {}

    /// @param point  called with (i, j) for new points: their source
    template <class Source>
    void add(std::size_t at, Index source_face, const Source& source) {
        Face f;
        const auto corners = corners_of(at, columns_);
        for (int k = 0; k < 3; ++k) {
            Index& n = number_[corners[k]];
            if (n < 0) {
                n = static_cast<Index>(mesh.place.size());
                mesh.place.push_back(corners[k]);
                mesh.source.push_back(source(corners[k]));
            }
            f[k] = n;
        }
        if (reversed_) std::swap(f[1], f[2]);
        mesh.faces.push_back(f);
        mesh.source_face.push_back(source_face);
    }

    /// Places on the lattice of the grid: (first + i, first + j) times the scale.
    ControlMesh done(double first, double scale) {
        for (const std::size_t p : mesh.place) {
            const std::size_t i = p / columns_, j = p % columns_;
            mesh.at.emplace_back(scale * (first + static_cast<double>(i)), scale * (first + static_cast<double>(j)), 0);
        }
        return std::move(mesh);
    }

    ControlMesh mesh;

private:
    std::size_t columns_;
    bool reversed_;
    Array<Index> number_;
};

/// Whether the mesh's faces run the other way round than corners_of(); its first one decides.
bool is_reversed(const Grid& grid, const Faces& mesh) {
    const auto at = static_cast<std::size_t>(
        std::find_if(grid.face.begin(), grid.face.end(), [](Index f) { return f >= 0; }) - grid.face.begin());
    const Face& f = mesh[grid.face[at]];
    const auto corners = corners_of(at, grid.columns);
    for (int k = 0; k < 3; ++k)
        if (f[k] == grid.vertex[corners[0]]) return f[(k + 1) % 3] != grid.vertex[corners[1]];
    return false;
}

/// Some face around each vertex that has one.
Array<Index> some_face(const Grid& grid, std::size_t vertices, const Faces& mesh) {
    Array<Index> face(vertices, -1);
    for (const Index f : grid.face)
        if (f >= 0)
            for (const Index v : mesh[f]) face[v] = f;
    return face;
}

/// Distance along the lattice, squared, of what lies between places.
Index squared_distance(Index i, Index j) { return i * i + j * j - i * j; }

}  // namespace

ControlMesh control_mesh(const Grid& grid, const GridPyramid& pyramid, int level, const Faces& mesh) {
    const Mask& mask = pyramid.mask(level);
    const Index most = *std::max_element(grid.vertex.begin(), grid.vertex.end());
    const Array<Index> face = some_face(grid, static_cast<std::size_t>(most) + 1, mesh);
    const Array<Index>& source = pyramid.source(level);
    Builder builder(mask.rows, mask.columns, is_reversed(grid, mesh));
    for (Index i = 0; i + 1 < mask.rows; ++i)
        for (Index j = 0; j + 1 < mask.columns; ++j)
            for (std::size_t k = 0; k < 2; ++k) {
                const std::size_t at = 2 * (static_cast<std::size_t>(i) * mask.columns + j) + k;
                const auto corners = corners_of(at, mask.columns);
                if (std::all_of(corners.begin(), corners.end(), [&](std::size_t p) { return mask.values[p] != 0; }))
                    builder.add(at, std::max<Index>(0, face[source[corners[0]]]),
                                [&](std::size_t p) { return source[p]; });
            }
    double first = 0;  // of point (0, 0) on this level's lattice
    for (int m = 0; m < level; ++m) first = first / 2 + pyramid.box(m).first;
    return builder.done(first, std::ldexp(1, level));
}

ControlMesh divided_grid(const Grid& grid, int steps, const Faces& mesh) {
    const Index n = 1 << steps, rows = n * (grid.rows - 1) + 1, columns = n * (grid.columns - 1) + 1;
    Builder builder(rows, columns, is_reversed(grid, mesh));
    for (std::size_t at = 0; at < grid.face.size(); ++at) {
        const Index face = grid.face[at];
        if (face < 0) continue;
        const auto corners = corners_of(at, grid.columns);
        const auto nearest = [&](std::size_t p) {
            const auto i = static_cast<Index>(p / columns), j = static_cast<Index>(p % columns);
            const auto distance = [&](std::size_t corner) {
                return squared_distance(i - n * static_cast<Index>(corner / grid.columns),
                                        j - n * static_cast<Index>(corner % grid.columns));
            };
            const auto less = [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); };
            return grid.vertex[*std::min_element(corners.begin(), corners.end(), less)];
        };
        const auto low = static_cast<std::size_t>(n) * (at / 2 / grid.columns) * columns +
                         static_cast<std::size_t>(n) * (at / 2 % grid.columns);
        const auto divide = [&](Index a, Index b, std::size_t k) {
            builder.add(2 * (low + static_cast<std::size_t>(a) * columns + b) + k, face, nearest);
        };
        for (Index a = 0; a < n; ++a)
            for (Index b = 0; b <= a; ++b) {
                const bool second = at % 2 != 0;  // its parts are those of the first kind, mirrored
                divide(second ? b : a, second ? a : b, second ? 1 : 0);
                if (b < a) divide(second ? b : a, second ? a : b, second ? 0 : 1);
            }
    }
    return builder.done(0, 1.0 / n);
}

}  // namespace multires
