#pragma once

#include "base/parallel.h"
#include "mesh/adjacency.h"
#include "random.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

/// What several unit tests share: the classes of meshes, random meshes, rings that compare as cycles and chains.
namespace multires::fixtures {

/// Every class of mesh, made once.
inline const std::vector<std::pair<std::string, Mesh>>& every_class() {
    static const auto all = shapes::every_class();
    return all;
}

/// Runs what follows with a number of threads, until the end of the scope.
class Threads {
public:
    explicit Threads(int count) { set_thread_count(count); }
    ~Threads() { set_thread_count(0); }
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;
};

inline Rings rings_with_flaps(const Mesh& mesh) {
    Rings rings = vertex_rings(mesh);
    find_flaps(rings);
    return rings;
}

/// One row, in a form that is equal for rows that are the same up to rotation (closed) and direction.
struct Row {
    RingKind kind = RingKind::isolated;
    std::vector<Index> ring;
    std::map<Index, bool> feature;                  ///< by neighbour
    std::map<std::pair<Index, Index>, Index> flap;  ///< by link edge

    bool operator==(const Row& o) const {
        return kind == o.kind && ring == o.ring && feature == o.feature && flap == o.flap;
    }
    friend std::ostream& operator<<(std::ostream& out, const Row& r) {
        out << "kind " << static_cast<int>(r.kind) << ", ring";
        for (const Index v : r.ring) out << ' ' << v << (r.feature.count(v) && r.feature.at(v) ? "*" : "");
        for (const auto& [edge, f] : r.flap) out << ", " << edge.first << '-' << edge.second << ": " << f;
        return out;
    }
};

/// Rotates and turns a cycle or chain so that equal ones have equal entries.
inline std::vector<Index> canonical(std::vector<Index> ring, bool closed) {
    if (ring.empty()) return ring;
    if (closed) std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
    if (closed ? ring[1] > ring.back() : ring[0] > ring.back()) std::reverse(ring.begin() + closed, ring.end());
    return ring;
}

/// A row of a table, its vertices renamed by `name`.
template <class Name>
Row row_of(const Rings& rings, Index r, const Name& name) {
    Row row;
    row.kind = rings.kind[r];
    const Index o = rings.offset[r], d = rings.size(r);
    const bool closed = row.kind == RingKind::closed;
    for (Index j = 0; j < d; ++j) {
        row.ring.push_back(name(rings.neighbor[o + j]));
        if (!rings.feature.empty()) row.feature[row.ring.back()] = rings.feature[o + j] != 0;
    }
    if (!rings.flap.empty())
        for (Index j = 0; j < d; ++j) {
            const Index to = closed ? row.ring[j + 1 < d ? j + 1 : 0] : row.ring[j];
            row.flap[std::minmax(row.ring[j], to)] = rings.has_flap(o + j) ? name(rings.flap[o + j]) : -1;
        }
    row.ring = canonical(std::move(row.ring), closed);
    return row;
}

inline Row row_of(const Rings& rings, Index r) {
    return row_of(rings, r, [](Index v) { return v; });
}

/// A random permutation of 0..n-1.
inline std::vector<Index> permutation(Index n, shapes::Random& random) {
    std::vector<Index> p(n);
    for (Index i = 0; i < n; ++i) p[i] = i;
    for (Index i = n; i > 1; --i) std::swap(p[i - 1], p[random.bits() % i]);
    return p;
}

/// A similarity: turn by a rotation, scale, move.
struct Motion {
    Eigen::Matrix3d rotation = Eigen::AngleAxisd(1.1, Vec3(0.3, -0.8, 0.5).normalized()).toRotationMatrix();
    double scale = 1;
    Vec3 offset{0.3, -1.7, 2.2};

    Vec3 operator()(const Vec3& p) const { return scale * (rotation * p) + offset; }
    Mesh operator()(Mesh mesh) const {
        for (Vec3& p : mesh.positions) p = (*this)(p);
        return mesh;
    }
};

/// A few vertices at random places and random faces over them: next to nothing is manifold.
inline Mesh random_soup(std::uint64_t seed) {
    shapes::Random random(seed);
    Mesh mesh;
    const Index vertices = 3 + static_cast<Index>(random.bits() % 14),
                faces = 1 + static_cast<Index>(random.bits() % 30);
    for (Index v = 0; v < vertices; ++v) mesh.positions.push_back(random.direction() * random.uniform(0.2, 1));
    const auto any = [&] { return static_cast<Index>(random.bits() % vertices); };
    for (Index f = 0; f < faces; ++f) mesh.faces.push_back({any(), any(), any()});
    return mesh;
}

/// A surface with random damage: faces gone, doubled or reversed, vertices of faces exchanged or welded, pieces apart.
inline Mesh damaged_mesh(std::uint64_t seed) {
    shapes::Random random(seed);
    Mesh mesh;
    switch (random.bits() % 5) {
    case 0:
        mesh = shapes::irregular_sphere(92, {0.3, 0.3, seed});
        break;
    case 1:
        mesh = shapes::plane(6, {0.3, 0.3, seed});
        break;
    case 2:
        mesh = shapes::moebius_band(9, 2);
        break;
    case 3:
        mesh = shapes::torus(8, 6);
        break;
    default:
        mesh = shapes::block(2, {0.2, 0, seed});
        break;
    }
    const double damage = random.chance(0.3) ? 0 : random.uniform(0, 0.12);
    const auto any = [&](std::size_t n) { return static_cast<Index>(random.bits() % n); };
    Faces faces;
    for (Face f : mesh.faces) {
        if (random.chance(damage)) {
            const int what = any(4);
            if (what == 0) continue;
            if (what == 1) faces.push_back(f);
            if (what == 2) std::swap(f[0], f[1]);
            if (what == 3 && random.chance(0.4)) f[any(3)] = any(mesh.positions.size());
        }
        faces.push_back(f);
    }
    if (random.chance(0.2)) {  // weld two vertices
        const Index a = any(mesh.positions.size()), b = any(mesh.positions.size());
        for (Face& f : faces) std::replace(f.begin(), f.end(), a, b);
    }
    if (random.chance(0.2)) mesh.positions[any(mesh.positions.size())] = mesh.positions[any(mesh.positions.size())];
    mesh.faces = faces;
    for (Vec3& p : mesh.positions) p += 0.02 * random.direction();
    return mesh;
}

}  // namespace multires::fixtures
