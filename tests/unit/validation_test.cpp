#include "mesh/validation.h"

#include "shapes.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace multires {
namespace {

std::string complaint(const Mesh& mesh) {
    try {
        require_usable(mesh);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Usable, EveryClassOfMeshIs) {
    for (const auto& [name, mesh] : shapes::every_class()) EXPECT_EQ(complaint(mesh), "") << name;
}

TEST(Usable, NoVerticesAndNoFaces) {
    EXPECT_TRUE(contains(complaint({}), "no vertices"));
    EXPECT_TRUE(contains(complaint({{Vec3(0, 0, 0), Vec3(1, 0, 0)}, {}}), "no faces"));
}

TEST(Usable, CoordinatesThatAreNotFinite) {
    for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        Mesh mesh = shapes::tetrahedron();
        mesh.positions[2].y() = bad;
        EXPECT_TRUE(contains(complaint(mesh), "1 vertex has")) << complaint(mesh);
        EXPECT_TRUE(contains(complaint(mesh), "vertex 2)")) << complaint(mesh);
        mesh.positions[3].z() = -bad;
        EXPECT_TRUE(contains(complaint(mesh), "2 vertices have")) << complaint(mesh);
    }
}

TEST(Usable, AllFacesDegenerate) {
    const Positions line{Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(3, 3, 3)};
    EXPECT_TRUE(contains(complaint({line, {{0, 1, 2}, {0, 0, 1}}}), "None of the 2 faces"));
}

TEST(Usable, BoxWithoutSize) {
    EXPECT_TRUE(contains(complaint({Positions(3, Vec3(5, 6, 7)), {{0, 1, 2}}}), "same point"));
    for (double scale : {1e-80, 1e80}) {
        Mesh mesh = shapes::tetrahedron();
        for (Vec3& p : mesh.positions) p *= scale;
        EXPECT_TRUE(contains(complaint(mesh), scale < 1 ? "too small" : "too large")) << complaint(mesh);
    }
}

TEST(Counts, ClosedSurfaceHasNothingUnusual) {
    for (const Mesh& mesh : {shapes::icosphere(4), shapes::torus(12, 8), shapes::tetrahedron()}) {
        const InputCounts c = count_input(mesh);
        EXPECT_EQ(c.vertices, static_cast<Index>(mesh.positions.size()));
        EXPECT_EQ(c.faces, static_cast<Index>(mesh.faces.size()));
        EXPECT_EQ(c.components, 1);
        EXPECT_EQ(c.unreferenced_vertices + c.duplicate_vertices + c.degenerate_faces + c.zero_area_faces, 0);
        EXPECT_EQ(c.duplicate_faces + c.boundary_edges + c.boundary_loops + c.non_manifold_edges, 0);
        EXPECT_EQ(c.non_manifold_vertices + c.inconsistent_edges + c.non_orientable_components, 0);
    }
}

TEST(Counts, BoundaryLoopsOfACylinder) {
    const InputCounts c = count_input(shapes::open_cylinder(10, 3));
    EXPECT_EQ(c.boundary_edges, 20);
    EXPECT_EQ(c.boundary_loops, 2);
    EXPECT_EQ(c.components, 1);
}

TEST(Counts, Components) {
    EXPECT_EQ(count_input(shapes::several_components()).components, 4);
    const InputCounts touching = count_input(shapes::bowtie());
    EXPECT_EQ(touching.components, 1);
    EXPECT_EQ(touching.non_manifold_vertices, 1);
    EXPECT_EQ(touching.non_manifold_edges, 0);
}

TEST(Counts, NonManifoldEdge) {
    const InputCounts c = count_input({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)},
                                       {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}});
    EXPECT_EQ(c.non_manifold_edges, 1);
    EXPECT_EQ(c.non_manifold_vertices, 2);
    EXPECT_EQ(c.boundary_edges, 6);
    EXPECT_EQ(c.boundary_loops, 1);
}

TEST(Counts, DegenerateAndDuplicateFaces) {
    const Positions square{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(0, 1, 0)};
    const InputCounts c = count_input({square, {{0, 2, 3}, {3, 2, 0}, {2, 3, 0}, {0, 0, 3}, {3, 3, 3}, {0, 1, 2}}});
    EXPECT_EQ(c.degenerate_faces, 2);
    EXPECT_EQ(c.zero_area_faces, 1);
    EXPECT_EQ(c.duplicate_faces, 2);
}

TEST(Counts, UnreferencedAndDuplicateVertices) {
    Mesh mesh = shapes::triangle();
    mesh.positions.push_back(mesh.positions[1]);
    mesh.positions.push_back(mesh.positions[1]);
    mesh.positions.emplace_back(7, 7, 0.0);
    mesh.positions.emplace_back(7, 7, -0.0);
    const InputCounts c = count_input(mesh);
    EXPECT_EQ(c.unreferenced_vertices, 4);
    EXPECT_EQ(c.duplicate_vertices, 3);
    EXPECT_EQ(count_input(shapes::duplicate_vertices()).boundary_loops,
              count_input(shapes::duplicate_vertices()).faces);
}

TEST(Counts, MoebiusBandIsNotOrientableAReversedFaceIs) {
    const InputCounts band = count_input(shapes::moebius_band());
    EXPECT_EQ(band.non_orientable_components, 1);
    EXPECT_GT(band.inconsistent_edges, 0);
    EXPECT_EQ(band.boundary_loops, 1);
    const InputCounts reversed = count_input(shapes::inconsistent_orientation());
    EXPECT_EQ(reversed.non_orientable_components, 0);
    EXPECT_GT(reversed.inconsistent_edges, 0);
}

TEST(Counts, EmptyMesh) {
    const InputCounts c = count_input(Mesh{});
    EXPECT_EQ(c.vertices + c.faces + c.components, 0);
}

}  // namespace
}  // namespace multires
