#pragma once

#include "mesh/mesh.h"

#include <array>
#include <vector>

/// Triangular grids: meshes whose inner vertices all have six neighbours, as points of the lattice A2.
///
/// A point has two integer coordinates (i, j); its neighbours are (i+1, j), (i, j+1), (i-1, j-1) and the three opposite
/// ones. These are the directions e1, e2 and e3 = -e1 - e2 of Dreger, Gross and Schlegel's barycentric plane.
namespace multires {

/// The six steps from a point to its neighbours, in the order of their angles.
inline constexpr std::array<std::array<Index, 2>, 6> lattice_steps{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 0}, {-1, -1}, {0, -1}}};

/// Faces connected by edges, on the lattice. Point (i, j) has place i columns + j.
struct Grid {
    Index rows = 0, columns = 0;
    Array<Index> vertex;  ///< rows by columns: the mesh's vertex at this point, -1 for none
    /// rows by columns by 2: the mesh's faces (i, j), (i+1, j), (i+1, j+1) and (i, j), (i+1, j+1), (i, j+1); -1 for
    /// none
    Array<Index> face;
    Index vertices = 0;  ///< how many points have one

    bool holds(Index i, Index j) const {
        return i >= 0 && i < rows && j >= 0 && j < columns && vertex[static_cast<std::size_t>(i) * columns + j] >= 0;
    }
};

/// The three points of the face of place `at` in Grid::face, as places in a raster of `columns`.
std::array<std::size_t, 3> corners_of(std::size_t at, Index columns);

/// What was found. A vertex belongs to one grid at most.
struct FoundGrids {
    std::vector<Grid> grids;      ///< largest first
    Index loose_vertices = 0;     ///< in faces, but in no grid
    Index off_lattice_faces = 0;  ///< that do not join three neighbours, as at the corners of holes in range maps
};

/// Gives lattice coordinates to the vertices by walking over the faces: across an edge (a, b) from c lies a + b - c.
/// Holes, missing faces, any shape of the outline, either diagonal and either orientation will do. Axes are turned so
/// that the box is small. Faces that repeat an index do not count.
/// @param faces     indices in range
/// @throws InputError  "not a triangular grid: ..." and why: inner vertices without six neighbours (diagonals that
///                     alternate are named), more than two faces at an edge, a mesh that closes on itself or overlaps
/// Cost: linear.
FoundGrids find_grids(const Faces& faces, Index vertices);

/// Groups of triangles missing inside a grid. Cost: linear in the box.
Index count_holes(const Grid& grid);

}  // namespace multires
