#pragma once

#include "hierarchy/hierarchy.h"
#include "mesh/validation.h"

#include "fixtures.h"

#include <cmath>
#include <set>

/// What must be true of every hierarchy, whatever the mesh and the options; each function fails the running test.
namespace multires::fixtures {

inline Rings marked_rings(const Mesh& mesh, double feature_angle) {
    Rings rings = vertex_rings(mesh);
    if (feature_angle > 0) mark_features_by_angle(rings, mesh.positions, feature_angle);
    return rings;
}

inline Hierarchy hierarchy_of(const Mesh& mesh, const HierarchyOptions& options = {}, double feature_angle = 0) {
    return build_hierarchy(marked_rings(mesh, feature_angle), mesh.positions, options);
}

/// The groupings that take different paths through the builders, with a small base.
inline std::vector<std::pair<std::string, HierarchyOptions>> groupings(Index base = 8) {
    HierarchyOptions options;
    options.base_vertices = base;
    std::vector<std::pair<std::string, HierarchyOptions>> all{{"one set per level", options}};
    options.sets_per_level = 3;
    all.emplace_back("three sets per level", options);
    options.grouping = Grouping::sequential;
    all.emplace_back("one vertex per level", options);
    options.level_ratio = 0.8;
    all.emplace_back("a fifth of the vertices per level", options);
    return all;
}

/// The mesh of the first `count` places.
inline Mesh mesh_of_prefix(const Hierarchy& h, const Mesh& mesh, Index count) {
    return {Positions(h.positions.begin(), h.positions.begin() + count), prefix_mesh(h, mesh.faces, count).faces};
}

/// Rows refer to their parent, and to nothing of their own set.
inline void expect_rows_of_set(const Hierarchy& h, RowRange set) {
    ASSERT_LT(set.begin, set.end);
    const Index below = h.odd.vertex(set.begin);
    for (Index r = set.begin; r < set.end; ++r) {
        const Index* begin = h.odd.begin(r);
        ASSERT_TRUE(std::count(begin, begin + h.odd.size(r), h.parent[h.odd.vertex(r)])) << "parent is no neighbour";
        for (Index j = 0; j < h.odd.size(r); ++j) {
            ASSERT_LT(begin[j], below);
            ASSERT_LT(h.odd.flap[h.odd.offset[r] + j], below);
        }
    }
}

inline void expect_numbering(const Hierarchy& h, const Mesh& mesh, const HierarchyOptions& options) {
    const Index n = static_cast<Index>(mesh.positions.size());
    ASSERT_EQ(h.vertices(), n);
    ASSERT_EQ(h.size.size(), h.levels.size() + 1);
    ASSERT_EQ(h.size[0], n);
    Array<Index> sorted = h.order;
    std::sort(sorted.begin(), sorted.end());
    for (Index v = 0; v < n; ++v) ASSERT_EQ(sorted[v], v) << "order is no permutation";
    for (Index p = 0; p < n; ++p) {
        ASSERT_EQ(h.positions[p], mesh.positions[h.order[p]]);
        ASSERT_TRUE(p < h.size.back() ? h.parent[p] == -1 : h.parent[p] >= 0 && h.parent[p] < p) << "place " << p;
    }
    const Rings rings = vertex_rings(mesh);
    EXPECT_EQ(h.irregular, std::count(rings.kind.begin(), rings.kind.end(), RingKind::irregular));
    EXPECT_EQ(h.isolated, std::count(rings.kind.begin(), rings.kind.end(), RingKind::isolated));
    EXPECT_TRUE(h.levels.empty() || h.size.back() >= options.base_vertices + h.isolated);
    for (Index p = h.size.back(); p < n; ++p)
        ASSERT_TRUE(rings.kind[h.order[p]] == RingKind::closed || rings.kind[h.order[p]] == RingKind::open);
    for (std::size_t k = 0; k < h.levels.size(); ++k) {
        const Level& level = h.levels[k];
        ASSERT_EQ(level.fine, h.size[k]);
        ASSERT_EQ(level.coarse, h.size[k + 1]);
        ASSERT_LT(level.coarse, level.fine);
        ASSERT_EQ(level.odd.size(), level.fine - level.coarse);
        ASSERT_EQ(h.odd.vertex(level.odd.begin), level.coarse);
        ASSERT_EQ(level.set(0).begin, level.odd.begin);
        ASSERT_EQ(level.set(level.sets() - 1).end, level.odd.end);
        for (std::size_t s = 0; s < level.sets(); ++s) expect_rows_of_set(h, level.set(s));
        if (testing::Test::HasFatalFailure()) return;
    }
    ASSERT_EQ(h.odd.rows(), n - h.size.back());
}

/// A stored row without feature marks; those have tests of their own.
inline Row plain_row(const Rings& rings, Index r) {
    Row row = row_of(rings, r);
    row.feature.clear();
    return row;
}

/// Without features: rows of level k's even vertices are those of its mesh, odd rows those at their removal.
/// @param stride  of the odd rows and the levels checked, which each take a whole mesh
inline void expect_stored_rings(const Hierarchy& h, const Mesh& mesh, Index stride) {
    for (std::size_t k = 0; k < h.levels.size(); ++k) {
        const Level& level = h.levels[k];
        if (k > 0 && k % (h.levels.size() > 100 ? stride : 1) != 0) continue;
        const Rings rings = rings_with_flaps(mesh_of_prefix(h, mesh, level.fine));
        const Rings& stored = h.even[k];
        ASSERT_TRUE(stored.rows() == level.coarse ||
                    (level.odd.size() == 1 && stored.rows() == h.odd.size(level.odd.begin)));
        std::set<Index> even(stored.vertices.begin(), stored.vertices.end());
        ASSERT_EQ(static_cast<Index>(even.size()), stored.rows()) << "a vertex has two rows";
        ASSERT_LT(*even.rbegin(), level.coarse);
        for (Index r = 0; r < stored.rows(); ++r)
            ASSERT_EQ(plain_row(stored, r), plain_row(rings, stored.vertex(r))) << "level " << k;
    }
    for (std::size_t k = 0; k < h.levels.size(); ++k) {
        const Level& level = h.levels[k];
        std::size_t set = 0;
        for (Index r = level.odd.begin; r < level.odd.end; ++r) {
            const Index p = h.odd.vertex(r);
            while (level.set(set).end <= r) ++set;
            if (p % stride != 0) continue;
            const Index begin = h.odd.vertex(level.set(set).begin), end = h.odd.vertex(level.set(set).end);
            // The mesh that the set was removed from. Of it, flaps in the same set are left out of the stored row, but
            // along the boundary the next but one takes their place.
            const Rings then = rings_with_flaps(mesh_of_prefix(h, mesh, end));
            Row stored = plain_row(h.odd, r), now = plain_row(then, p);
            for (auto& [link, flap] : now.flap) {
                if (flap >= begin && now.kind == RingKind::open) flap = next_on_boundary(then, link.first, flap);
                if (flap < begin) continue;
                ASSERT_LT(stored.flap[link], begin);  // -1, or what was there after vertices of the set had gone
                flap = stored.flap[link];
            }
            ASSERT_EQ(stored, now) << "place " << p << " of level " << k;
        }
    }
    const Rings base = rings_with_flaps(mesh_of_prefix(h, mesh, h.size.back()));
    ASSERT_EQ(h.base.rows(), h.size.back());
    for (Index r = 0; r < h.base.rows(); ++r) ASSERT_EQ(plain_row(h.base, r), plain_row(base, r)) << "base";
}

/// V - E + F of what is in faces.
inline Index euler(const Mesh& mesh) {
    std::set<Index> vertices;
    std::set<std::pair<Index, Index>> edges;
    Index faces = 0;
    for (const Face& f : mesh.faces) {
        if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) continue;
        ++faces;
        for (int k = 0; k < 3; ++k) vertices.insert(f[k]), edges.insert(std::minmax(f[k], f[(k + 1) % 3]));
    }
    return static_cast<Index>(vertices.size()) - static_cast<Index>(edges.size()) + faces;
}

/// The topology of every level is that of the input.
inline void expect_topology(const Hierarchy& h, const Mesh& mesh, std::size_t stride) {
    const InputCounts whole = count_input(mesh);
    const Index characteristic = euler(mesh);
    for (std::size_t k = 1; k < h.size.size(); ++k) {
        if (k + 1 < h.size.size() && k % stride != 0) continue;
        SCOPED_TRACE("level " + std::to_string(k));
        const Mesh level = mesh_of_prefix(h, mesh, h.size[k]);
        const InputCounts counts = count_input(level);
        ASSERT_EQ(euler(level), characteristic);
        ASSERT_EQ(counts.components, whole.components);
        ASSERT_EQ(counts.boundary_loops, whole.boundary_loops);
        ASSERT_EQ(counts.non_manifold_edges, whole.non_manifold_edges);
        ASSERT_EQ(counts.non_manifold_vertices, whole.non_manifold_vertices);
        ASSERT_EQ(counts.non_orientable_components, whole.non_orientable_components);
        ASSERT_EQ(counts.duplicate_faces, whole.duplicate_faces);
    }
}

/// No collapse turns a normal by more than the limit. Collapses are taken one by one, or set by set where each face
/// meets one of them at most.
inline void expect_normals(const Hierarchy& h, const Mesh& mesh, double limit_degrees, Index stride) {
    const auto compare = [&](Index fine, Index coarse) {
        const LevelMesh a = prefix_mesh(h, mesh.faces, fine), b = prefix_mesh(h, mesh.faces, coarse);
        const auto sides = [&](const Face& f) {
            return std::pair<Vec3, Vec3>(h.positions[f[1]] - h.positions[f[0]], h.positions[f[2]] - h.positions[f[0]]);
        };
        for (std::size_t i = 0, j = 0; j < b.faces.size(); ++j) {
            while (a.source_face[i] != b.source_face[j]) ++i;
            if (a.faces[i] == b.faces[j]) continue;
            const auto [s, t] = sides(a.faces[i]);
            const auto [u, w] = sides(b.faces[j]);
            const Vec3 n = s.cross(t), m = u.cross(w);
            const double size = s.squaredNorm() + t.squaredNorm();
            if (n.norm() <= 1e-9 * size) continue;  // no normal to turn
            EXPECT_GT(m.norm(), 0);
            EXPECT_LE(std::atan2(n.cross(m).norm(), n.dot(m)) * 180 / std::acos(-1.0), limit_degrees + 1e-6);
        }
    };
    for (const Level& level : h.levels)
        if (level.independent() && level.odd.size() > 1)
            compare(level.fine, level.coarse);
        else
            for (Index p = level.coarse; p < level.fine; ++p)
                if (p % stride == 0) compare(p + 1, p);
}

/// An edge is marked at both ends or at neither, on every level that stores all its rings.
inline void expect_marks_agree(const Hierarchy& h) {
    const auto agree = [&](const Rings& all, RowRange odd, std::size_t level) {
        std::map<std::pair<Index, Index>, bool> mark;
        const auto take = [&](const Rings& rings, RowRange rows) {
            for (Index r = rows.begin; r < rows.end; ++r)
                for (const auto& [w, marked] : row_of(rings, r).feature) {
                    const auto at = mark.insert({std::minmax(rings.vertex(r), w), marked}).first;
                    ASSERT_EQ(at->second, marked) << "edge " << rings.vertex(r) << ' ' << w << ", level " << level;
                }
        };
        take(all, {0, all.rows()});
        take(h.odd, odd);
    };
    for (std::size_t k = 0; k < h.levels.size(); ++k) {
        const bool whole = h.levels[k].independent() && h.even[k].rows() == h.levels[k].coarse;
        agree(h.even[k], whole ? h.levels[k].odd : RowRange(), k);
    }
    agree(h.base, {}, h.levels.size());
}

inline void expect_hierarchy(const Hierarchy& h, const Mesh& mesh, const HierarchyOptions& options, Index stride) {
    expect_numbering(h, mesh, options);
    if (testing::Test::HasFatalFailure()) return;
    expect_stored_rings(h, mesh, stride);
    expect_topology(h, mesh, h.levels.size() > 100 ? stride : 1);
    expect_normals(h, mesh, options.normal_limit_degrees, stride);
}

}  // namespace multires::fixtures
