#include "grids/lattice.h"

#include "base/error.h"
#include "filter_fixtures.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

// Which meshes are triangular grids, and where their vertices lie on the lattice.

namespace multires {
namespace {

FoundGrids found(const Mesh& mesh) { return find_grids(mesh.faces, static_cast<Index>(mesh.positions.size())); }

std::string refusal(const Mesh& mesh) {
    try {
        found(mesh);
        return "";
    } catch (const InputError& e) {
        return e.what();
    }
}

/// Vertices and faces in another order, faces beginning at other corners, and turned over.
Mesh shuffled(const Mesh& mesh, std::uint64_t seed) {
    shapes::Random random(seed);
    const auto number = fixtures::permutation(static_cast<Index>(mesh.positions.size()), random);
    const auto order = fixtures::permutation(static_cast<Index>(mesh.faces.size()), random);
    Mesh out = mesh;
    for (std::size_t v = 0; v < number.size(); ++v) out.positions[number[v]] = mesh.positions[v];
    for (std::size_t f = 0; f < order.size(); ++f) {
        const Face& g = mesh.faces[order[f]];
        out.faces[f] = {number[g[2]], number[g[1]], number[g[0]]};
    }
    return out;
}

/// Every face is where the grid says, and no vertex or face is lost.
void expect_covers(const Mesh& mesh, const FoundGrids& all) {
    std::set<Index> vertices, faces;
    for (const Grid& grid : all.grids) {
        for (const Index v : grid.vertex)
            EXPECT_TRUE(v < 0 || vertices.insert(v).second) << "vertex " << v << " is there twice";
        for (std::size_t at = 0; at < grid.face.size(); ++at) {
            if (grid.face[at] < 0) continue;
            EXPECT_TRUE(faces.insert(grid.face[at]).second);
            std::set<Index> here, there(mesh.faces[grid.face[at]].begin(), mesh.faces[grid.face[at]].end());
            for (const std::size_t p : corners_of(at, grid.columns)) here.insert(grid.vertex[p]);
            EXPECT_EQ(here, there);
        }
    }
    EXPECT_EQ(faces.size(), mesh.faces.size());
}

}  // namespace

TEST(FindGrids, FindsGridsOfEveryOutlineAndDiagonal) {
    for (const auto cut : {shapes::GridCut::first, shapes::GridCut::second})
        for (const bool triangle : {false, true})
            for (const double hole : {0.0, 5.0}) {
                shapes::GridShape shape;
                shape.cut = cut, shape.triangle = triangle, shape.hole = hole;
                for (const Mesh& mesh : {shapes::grid_terrain(shape), shuffled(shapes::grid_terrain(shape), 3)}) {
                    const FoundGrids all = found(mesh);
                    ASSERT_EQ(all.grids.size(), 1u);
                    expect_covers(mesh, all);
                    EXPECT_EQ(all.loose_vertices, 0);
                    EXPECT_LE(all.grids[0].vertex.size(), 24u * 30u) << "the box is as small as it can be";
                    EXPECT_TRUE(triangle || count_holes(all.grids[0]) == (hole > 0 ? 1 : 0));
                }
            }
}

TEST(FindGrids, FindsGridsWithMissingFaces) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        shapes::GridShape shape;
        shape.missing = 0.1, shape.seed = seed;
        const Mesh mesh = shuffled(shapes::grid_terrain(shape), seed);
        const FoundGrids all = found(mesh);
        EXPECT_GT(all.grids[0].vertices, 0.97 * static_cast<double>(mesh.positions.size()));
        EXPECT_LT(all.off_lattice_faces, 1);
    }
}

TEST(FindGrids, FindsEachComponent) {
    shapes::GridShape small;
    small.rows = 9, small.columns = 7, small.cut = shapes::GridCut::second;
    const Mesh mesh = shapes::join(shapes::grid_terrain(small), shapes::grid_terrain({}), {100, 0, 0});
    const FoundGrids all = found(mesh);
    ASSERT_EQ(all.grids.size(), 2u);
    EXPECT_EQ(all.grids[0].vertices, 24 * 30);
    EXPECT_EQ(all.grids[1].vertices, 9 * 7);
    expect_covers(mesh, all);
}

/// A range map in which a sample is missing: what meshers make of its four cells are triangles across the corners.
TEST(FindGrids, LeavesOutTrianglesAcrossCornersOfHoles) {
    Mesh mesh = shapes::grid_terrain({});
    const auto at = [](Index i, Index j) { return i * 30 + j; };
    const Index gone = at(10, 10);
    Faces faces;
    for (const Face& f : mesh.faces)
        if (f[0] != gone && f[1] != gone && f[2] != gone) faces.push_back(f);
    faces.push_back({at(10, 11), at(11, 11), at(11, 10)});
    faces.push_back({at(9, 9), at(9, 10), at(10, 9)});
    mesh.faces = faces;
    const FoundGrids all = found(mesh);
    ASSERT_EQ(all.grids.size(), 1u);
    EXPECT_EQ(all.grids[0].vertices, 24 * 30 - 1);
    EXPECT_EQ(all.off_lattice_faces, 2);
}

TEST(FindGrids, RefusesAlternatingDiagonalsByName) {
    shapes::GridShape shape;
    shape.cut = shapes::GridCut::alternating;
    EXPECT_NE(refusal(shapes::grid_terrain(shape)).find("diagonals alternate"), std::string::npos);
}

TEST(FindGrids, RefusesWhatClosesOnItselfAndEdgesOfThreeFaces) {
    EXPECT_NE(refusal(shapes::torus(24, 12)).find("closes on itself"), std::string::npos);
    EXPECT_NE(refusal(shapes::open_cylinder(24, 8)).find("closes on itself"), std::string::npos);
    EXPECT_NE(refusal(shapes::three_faces_on_an_edge()).find("more than two faces"), std::string::npos);
}

TEST(FindGrids, TakesNoIrregularMeshForAGrid) {
    const std::set<std::string> grids = {"triangle", "two_triangles", "duplicate_vertices", "fan"};
    int refused = 0;
    for (const auto& [name, mesh] : fixtures::every_class()) {
        const std::string why = refusal(mesh);
        if (grids.count(name)) continue;
        EXPECT_EQ(why.find("not a triangular grid: "), 0u) << name;
        ++refused;
    }
    EXPECT_GE(refused, 20);
    for (const Mesh& mesh : {shapes::scan(3000, {}), shapes::plane(30), shapes::disk(20), shapes::icosphere(16)})
        EXPECT_NE(refusal(mesh), "");
}

}  // namespace multires
