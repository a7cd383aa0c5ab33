#pragma once

#include "mesh/mesh.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

/// Meshes made by formula, for tests and benchmarks. Every function gives the same mesh for the same arguments on every
/// platform (up to the last bits of sin and cos). Faces are oriented outwards (up, for height fields) unless said
/// otherwise. Cost: linear in the mesh.
namespace multires::shapes {

// ---- Regular surfaces
// ------------------------------------------------------------------------------------------------

/// The unit sphere: an icosahedron whose faces are divided into frequency^2 each; 10 frequency^2 + 2 vertices.
Mesh icosphere(Index frequency);

/// A torus about the z axis, `around` by `across` quadrilaterals (each >= 3) cut along the same diagonal.
Mesh torus(Index around, Index across, double radius = 1, double tube = 0.4);

/// A cylinder about the z axis without caps: `around` (>= 3) by `along` (>= 1) quadrilaterals.
Mesh open_cylinder(Index around, Index along, double radius = 1, double height = 2);

/// The closed fan of `valence` (>= 3) triangles around one vertex (vertex 0) at the given height above a unit circle.
Mesh fan(Index valence, double height = 0);

// ---- Irregular surfaces
// ----------------------------------------------------------------------------------------------

/// Irregularity of a triangulation.
struct Irregular {
    double jitter = 0.3;  ///< vertices move by up to this fraction of the mean edge length, within the surface
    double flips = 0.3;   ///< fraction of the edges that are tried to be flipped; flips that fold are not done
    std::uint64_t seed = 1;
};

/// The square [0, 1]^2 in the plane z = 0 with n by n quadrilaterals, exactly planar. Boundary vertices move along
/// the boundary only, corners not at all.
Mesh plane(Index n, const Irregular& options = {});

/// The unit disk in the plane z = 0 with `rings` rings of vertices around the centre.
Mesh disk(Index rings, const Irregular& options = {});

/// The unit sphere with about `vertices` vertices (the nearest number 10 n^2 + 2).
Mesh irregular_sphere(Index vertices, const Irregular& options = {});

/// A machined block, 3 by 1 by 2 with a round groove and a ramp across its top, `n` vertices per unit of length: planar
/// faces, one curved face and sharp creases (between 37 and 90 degrees), finely and irregularly tessellated. Creases
/// are followed by edges exactly. (No flips: they could cross a crease.)
Mesh block(Index n, const Irregular& options = {});

/// Flips random edges of a mesh in place; never makes double edges, valences below 4 or triangles whose normals turn by
/// more than 60 degrees or with an angle below 10 degrees. Edges with other than two faces stay.
void flip_edges(Mesh& mesh, double fraction, std::uint64_t seed);

// ---- Signals of known wavelength
// -------------------------------------------------------------------------------------

/// A radial displacement of the unit sphere that is the sum of two spherical harmonics of one degree each.
struct BandedSphere {
    Mesh mesh;                 ///< positions = (1 + low + high) sphere
    Positions sphere;          ///< #V by 3 on the unit sphere
    std::vector<double> low;   ///< #V: the coarse component
    std::vector<double> high;  ///< #V: the fine component
};

struct BandedSphereOptions {
    Index vertices = 10000;
    Index low_degree = 4;  ///< of the harmonics; their wavelength is 2 pi / sqrt(degree (degree + 1))
    Index high_degree = 40;
    double low_amplitude = 0.05;  ///< RMS over the vertices, in radii
    double high_amplitude = 0.004;
    Irregular irregular = {};
};

BandedSphere banded_sphere(const BandedSphereOptions& options = {});

/// A real spherical harmonic of exactly this degree with RMS 1 over the given points of the unit sphere: a random sum
/// of zonal harmonics P_degree(d . x).
std::vector<double> harmonic(const Positions& sphere, Index degree, std::uint64_t seed);

/// A height field with data on it that have more detail than the heights.
struct Terrain {
    Mesh mesh;                     ///< x, y in [0, 1]
    std::vector<double> color;     ///< #V by 4 (r, g, b, a in 0..255): a ramp by height, with fine stripes
    std::vector<double> texcoord;  ///< #V by 2: x, y
    std::vector<double> scalar;    ///< #V: a "temperature", smooth in x with a front (a jump) across the terrain
};

/// n by n quadrilaterals, as plane().
Terrain terrain(Index n, const Irregular& options = {});

/// The same on a triangular grid, rough: every vertex has a step of its own, a twentieth of an edge.
Terrain regular_terrain(Index n);

/// A closed irregular surface with bumps on all scales, as a scanner would give it; about `vertices` vertices (the
/// nearest number 10 n^2 + 2, up to 100 million). The bumps' amplitudes fall with their wavelengths, down to 4 edges.
Mesh scan(Index vertices, const Irregular& options = {});

/// A curved stone with letters cut into it, as an open patch that faces up, in millimetres: x to the right along the
/// lines, twice as wide as high.
struct EngravedStone {
    Mesh mesh;
    std::vector<double> cut;  ///< #V: depth of the letters at each vertex, mm, 0 beside them
};

struct EngravedStoneOptions {
    double width = 120, spacing = 0.4;
    double depth = 0.3, stroke = 2;  ///< of the letters: V-shaped, width at the surface
    double chisel = 0.06;            ///< amplitude of furrows of 2.5 to 5 mm
    double noise = 0.03;             ///< standard deviation, along z
    Irregular irregular = {};        ///< its seed does not count
    std::uint64_t seed = 1;          ///< of the stone's form (radii from 60 to 400, bumps of 25 to 80), furrows, noise
};

EngravedStone engraved_stone(const EngravedStoneOptions& options = {});

// ---- Triangular grids
// ------------------------------------------------------------------------------------------------

/// Which diagonals the cells of a grid are cut along. Alternating ones make no triangular grid.
enum class GridCut { first, second, alternating };

struct GridShape {
    Index rows = 24, columns = 30;  ///< points
    GridCut cut = GridCut::first;
    bool triangle = false;  ///< only the points with i + j less than rows and columns
    double hole = 0;        ///< radius of a round hole, in cells
    double missing = 0;     ///< probability of each face to be left out
    double noise = 0.2;     ///< of heights, in cells
    std::uint64_t seed = 1;
};

/// A terrain on a triangular grid, facing up: cells of size 1, a ridge, hills and noise. Vertices whose faces are all
/// missing stay.
Mesh grid_terrain(const GridShape& shape = {});

// ---- Joining
// ---------------------------------------------------------------------------------------------------------

/// Both meshes in one, `b` moved by `offset`.
Mesh join(const Mesh& a, const Mesh& b, const Vec3& offset = Vec3::Zero());

/// A sphere, a torus, a cylinder and a single triangle side by side.
Mesh several_components();

// ---- Small literal meshes that break assumptions
// ---------------------------------------------------------------------

Mesh triangle();
Mesh two_triangles();  ///< sharing an edge
Mesh tetrahedron();
Mesh double_sided_triangle();  ///< two faces, each the other's back
Mesh valence_three();          ///< a tetrahedron whose faces are each divided at a new vertex, off the face
Mesh moebius_band(Index around = 24, Index across = 4);
Mesh bowtie();                  ///< two spheres that share one vertex
Mesh three_faces_on_an_edge();  ///< a sphere with a fin
Mesh duplicate_faces();         ///< a sphere, some faces twice, once reversed
Mesh duplicate_vertices();      ///< a sphere as a triangle soup: no face shares a vertex
Mesh coincident_vertices();     ///< a closed sphere, some edges collapsed to length 0 with their faces still there
Mesh degenerate_faces();        ///< a sphere with added faces that repeat an index
Mesh collinear_faces();  ///< a planar square with vertices on edges: faces of no area with three different corners
Mesh unreferenced_vertices();     ///< a sphere with vertices in no face, first, in the middle and last
Mesh inconsistent_orientation();  ///< a sphere, every third face reversed

/// A sphere with one vertex that is not finite; not part of every_class().
Mesh not_finite(double value);

/// A small mesh (at most a few thousand vertices) of each class above that filters must accept.
std::vector<std::pair<std::string, Mesh>> every_class();

}  // namespace multires::shapes
