#include "base/angles.h"
#include "shapes.h"

#include <array>
#include <cmath>
#include <map>

namespace multires::shapes {

namespace {

const std::array<Vec3, 12>& icosahedron_corners() {
    static const double g = (1 + std::sqrt(5.0)) / 2;
    static const std::array<Vec3, 12> corners{Vec3(-1, g, 0), Vec3(1, g, 0), Vec3(-1, -g, 0), Vec3(1, -g, 0),
                                              Vec3(0, -1, g), Vec3(0, 1, g), Vec3(0, -1, -g), Vec3(0, 1, -g),
                                              Vec3(g, 0, -1), Vec3(g, 0, 1), Vec3(-g, 0, -1), Vec3(-g, 0, 1)};
    return corners;
}

constexpr Face icosahedron_faces[20] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                        {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                        {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                        {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};

/// Numbers the vertices of the divided icosahedron: 12 corners, then those inside edges, then those inside faces.
class IcosahedronGrid {
public:
    explicit IcosahedronGrid(Index n) : n_(n) {
        for (const Face& f : icosahedron_faces) {
            for (int k = 0; k < 3; ++k) {
                const auto edge = std::minmax(f[k], f[(k + 1) % 3]);
                edges_.emplace(edge, static_cast<Index>(edges_.size()));
            }
        }
    }

    /// Vertex of a face at the barycentric coordinates (n-i-j, i, j) / n.
    Index vertex(Index face, Index i, Index j) const {
        const Face& f = icosahedron_faces[face];
        const Index steps[3] = {n_ - i - j, i, j};
        for (int k = 0; k < 3; ++k) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            if (steps[k] == n_) return f[k];
            if (steps[m] == 0 && steps[k] > 0 && steps[l] > 0) return on_edge(f[k], f[l], steps[l]);
        }
        const Index inside = (n_ - 1) * (n_ - 2) / 2;
        const Index row = (i - 1) * (n_ - 1) - (i - 1) * i / 2;  // rows of n-2, n-3, ... entries
        return 12 + 30 * (n_ - 1) + face * inside + row + (j - 1);
    }

private:
    Index on_edge(Index a, Index b, Index steps_from_a) const {
        const Index edge = edges_.at(std::minmax(a, b));
        return 12 + edge * (n_ - 1) + (a < b ? steps_from_a : n_ - steps_from_a) - 1;
    }

    Index n_;
    std::map<std::pair<Index, Index>, Index> edges_;
};

}  // namespace

Mesh icosphere(Index frequency) {
    const Index n = frequency;
    const IcosahedronGrid grid(n);
    Mesh mesh;
    mesh.positions.resize(10 * static_cast<std::size_t>(n) * n + 2);
    mesh.faces.reserve(20 * static_cast<std::size_t>(n) * n);
    for (Index face = 0; face < 20; ++face) {
        const auto& corners = icosahedron_corners();
        const Face& f = icosahedron_faces[face];
        for (Index i = 0; i <= n; ++i) {
            for (Index j = 0; i + j <= n; ++j) {
                const Index v = grid.vertex(face, i, j);
                mesh.positions[v] = (corners[f[0]] * (n - i - j) + corners[f[1]] * i + corners[f[2]] * j).normalized();
                if (i + j == n) continue;
                const Index next_i = grid.vertex(face, i + 1, j), next_j = grid.vertex(face, i, j + 1);
                mesh.faces.push_back({v, next_i, next_j});
                if (i + j + 1 < n) mesh.faces.push_back({next_i, grid.vertex(face, i + 1, j + 1), next_j});
            }
        }
    }
    return mesh;
}

Mesh torus(Index around, Index across, double radius, double tube) {
    Mesh mesh;
    for (Index i = 0; i < around; ++i) {
        for (Index j = 0; j < across; ++j) {
            const double u = 2 * pi * i / around, v = 2 * pi * j / across, r = radius + tube * std::cos(v);
            mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), tube * std::sin(v));
            const Index a = i * across + j, b = (i + 1) % around * across + j;
            const Index c = (i + 1) % around * across + (j + 1) % across, d = i * across + (j + 1) % across;
            mesh.faces.push_back({a, b, c});
            mesh.faces.push_back({a, c, d});
        }
    }
    return mesh;
}

Mesh open_cylinder(Index around, Index along, double radius, double height) {
    Mesh mesh;
    for (Index j = 0; j <= along; ++j) {
        for (Index i = 0; i < around; ++i) {
            const double u = 2 * pi * i / around;
            mesh.positions.emplace_back(radius * std::cos(u), radius * std::sin(u), height * j / along - height / 2);
            if (j == along) continue;
            const Index a = j * around + i, b = j * around + (i + 1) % around;
            mesh.faces.push_back({a, b, b + around});
            mesh.faces.push_back({a, b + around, a + around});
        }
    }
    return mesh;
}

Mesh fan(Index valence, double height) {
    Mesh mesh;
    mesh.positions.emplace_back(0, 0, height);
    for (Index j = 0; j < valence; ++j) {
        const double u = 2 * pi * j / valence;
        mesh.positions.emplace_back(std::cos(u), std::sin(u), 0);
        mesh.faces.push_back({0, 1 + j, 1 + (j + 1) % valence});
    }
    return mesh;
}

Mesh join(const Mesh& a, const Mesh& b, const Vec3& offset) {
    Mesh mesh(a);
    const auto base = static_cast<Index>(a.positions.size());
    for (const Vec3& p : b.positions) mesh.positions.push_back(p + offset);
    for (const Face& f : b.faces) mesh.faces.push_back({f[0] + base, f[1] + base, f[2] + base});
    return mesh;
}

Mesh several_components() {
    Mesh mesh = join(icosphere(6), torus(24, 12), Vec3(3, 0, 0));
    mesh = join(mesh, open_cylinder(16, 8), Vec3(6, 0, 0));
    return join(mesh, triangle(), Vec3(8, 0, 0));
}

}  // namespace multires::shapes
