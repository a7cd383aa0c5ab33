#include "base/angles.h"
#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace multires::shapes {

namespace {

Mesh small_sphere() { return irregular_sphere(162); }

}  // namespace

Mesh triangle() { return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}; }

Mesh two_triangles() { return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.2}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}; }

Mesh tetrahedron() {
    return {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

Mesh double_sided_triangle() { return {triangle().positions, {{0, 1, 2}, {0, 2, 1}}}; }

Mesh valence_three() {
    Mesh mesh = tetrahedron();
    const Faces faces = std::exchange(mesh.faces, {});
    for (const Face& f : faces) {
        const Vec3 middle = (mesh.positions[f[0]] + mesh.positions[f[1]] + mesh.positions[f[2]]) / 3;
        const auto v = static_cast<Index>(mesh.positions.size());
        mesh.positions.push_back(1.4 * middle);
        for (int k = 0; k < 3; ++k) mesh.faces.push_back({f[k], f[(k + 1) % 3], v});
    }
    return mesh;
}

Mesh moebius_band(Index around, Index across) {
    Mesh mesh;
    // One row more in each direction than there are columns; the last column is the first one upside down.
    const auto vertex = [&](Index i, Index j) {
        return i < around ? i * (across + 1) + j : (i - around) * (across + 1) + across - j;
    };
    for (Index i = 0; i < around; ++i) {
        for (Index j = 0; j <= across; ++j) {
            const double u = 2 * pi * i / around, side = static_cast<double>(j) / across - 0.5;
            const double r = 1 + side * std::cos(u / 2);
            mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), side * std::sin(u / 2));
            if (j == across) continue;
            mesh.faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
            mesh.faces.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    }
    return mesh;
}

Mesh bowtie() {
    const Mesh sphere = small_sphere();
    const auto count = static_cast<Index>(sphere.positions.size());
    Mesh mesh = join(sphere, sphere, 2 * sphere.positions[0]);
    // The second sphere touches vertex 0 of the first one; its vertex nearest to there becomes that vertex.
    Index twin = count;
    for (Index v = count; v < 2 * count; ++v) {
        const auto distance = [&](Index w) { return (mesh.positions[w] - mesh.positions[0]).squaredNorm(); };
        if (distance(v) < distance(twin)) twin = v;
    }
    for (Face& f : mesh.faces) std::replace(f.begin(), f.end(), twin, 0);
    mesh.positions.erase(mesh.positions.begin() + twin);
    for (Face& f : mesh.faces) {
        for (Index& v : f) v -= v > twin ? 1 : 0;
    }
    return mesh;
}

Mesh three_faces_on_an_edge() {
    Mesh mesh = small_sphere();
    const Face f = mesh.faces[0];
    mesh.faces.push_back({f[1], f[0], static_cast<Index>(mesh.positions.size())});
    mesh.positions.push_back(1.5 * (mesh.positions[f[0]] + mesh.positions[f[1]]) / 2);
    return mesh;
}

Mesh duplicate_faces() {
    Mesh mesh = small_sphere();
    mesh.faces.push_back(mesh.faces[10]);
    const Face f = mesh.faces[100];
    mesh.faces.push_back({f[1], f[2], f[0]});
    mesh.faces.push_back({f[2], f[1], f[0]});
    return mesh;
}

Mesh duplicate_vertices() {
    const Mesh sphere = small_sphere();
    Mesh mesh;
    for (const Face& f : sphere.faces) {
        const auto v = static_cast<Index>(mesh.positions.size());
        for (const Index corner : f) mesh.positions.push_back(sphere.positions[corner]);
        mesh.faces.push_back({v, v + 1, v + 2});
    }
    return mesh;
}

Mesh coincident_vertices() {
    Mesh mesh = small_sphere();
    for (std::size_t f = 0; f < mesh.faces.size(); f += 40) {
        mesh.positions[mesh.faces[f][0]] = mesh.positions[mesh.faces[f][1]];
    }
    return mesh;
}

Mesh degenerate_faces() {
    Mesh mesh = small_sphere();
    const Face f = mesh.faces[7];
    mesh.faces.push_back({f[0], f[0], f[1]});
    mesh.faces.insert(mesh.faces.begin(), {f[2], f[2], f[2]});
    return mesh;
}

Mesh collinear_faces() {
    Mesh mesh = plane(8, {0, 0, 1});  // coordinates are multiples of 1/8: midpoints are exact
    for (Index v : {20, 24, 40, 57}) {
        // Onto the middle of the edge opposite to it in one of its faces.
        const auto face = std::find_if(mesh.faces.begin(), mesh.faces.end(),
                                       [v](const Face& f) { return std::find(f.begin(), f.end(), v) != f.end(); });
        const auto corner = std::find(face->begin(), face->end(), v) - face->begin();
        mesh.positions[v] = (mesh.positions[(*face)[(corner + 1) % 3]] + mesh.positions[(*face)[(corner + 2) % 3]]) / 2;
    }
    return mesh;
}

Mesh unreferenced_vertices() {
    Mesh mesh = small_sphere();
    mesh.positions.push_back({3, 0, 0});
    const Index inserted[] = {0, 80};
    for (const Index at : inserted) {
        mesh.positions.insert(mesh.positions.begin() + at, Vec3(0, 0, 2));
        for (Face& f : mesh.faces) {
            for (Index& v : f) v += v >= at ? 1 : 0;
        }
    }
    return mesh;
}

Mesh inconsistent_orientation() {
    Mesh mesh = small_sphere();
    for (std::size_t f = 0; f < mesh.faces.size(); f += 3) std::swap(mesh.faces[f][0], mesh.faces[f][1]);
    return mesh;
}

Mesh not_finite(double value) {
    Mesh mesh = small_sphere();
    mesh.positions[5].y() = value;
    return mesh;
}

std::vector<std::pair<std::string, Mesh>> every_class() {
    return {{"plane", plane(12)},
            {"plane_regular", plane(8, {0, 0, 1})},
            {"disk", disk(8)},
            {"icosphere", icosphere(6)},
            {"irregular_sphere", irregular_sphere(1000)},
            {"banded_sphere", banded_sphere({2000, 4, 12, 0.05, 0.01, {}}).mesh},
            {"torus", torus(24, 12)},
            {"open_cylinder", open_cylinder(20, 10)},
            {"block", block(8)},
            {"terrain", terrain(24).mesh},
            {"scan", scan(1500)},
            {"several_components", several_components()},
            {"fan", fan(300, 0.5)},
            {"triangle", triangle()},
            {"two_triangles", two_triangles()},
            {"tetrahedron", tetrahedron()},
            {"double_sided_triangle", double_sided_triangle()},
            {"valence_three", valence_three()},
            {"moebius_band", moebius_band()},
            {"bowtie", bowtie()},
            {"three_faces_on_an_edge", three_faces_on_an_edge()},
            {"duplicate_faces", duplicate_faces()},
            {"duplicate_vertices", duplicate_vertices()},
            {"coincident_vertices", coincident_vertices()},
            {"degenerate_faces", degenerate_faces()},
            {"collinear_faces", collinear_faces()},
            {"unreferenced_vertices", unreferenced_vertices()},
            {"inconsistent_orientation", inconsistent_orientation()}};
}

}  // namespace multires::shapes
