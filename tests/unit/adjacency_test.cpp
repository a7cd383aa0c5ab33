#include "mesh/adjacency.h"

#include "fixtures.h"

#include <set>

namespace multires {
namespace {

using fixtures::canonical;
using fixtures::every_class;
using fixtures::rings_with_flaps;
using fixtures::Row;
using fixtures::row_of;

/// The faces that count, by edge and by vertex: what rings are made of, kept in the plainest way.
struct Neighbourhoods {
    explicit Neighbourhoods(const Mesh& mesh) : link(mesh.positions.size()) {
        for (const Face& f : mesh.faces) {
            if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) continue;
            for (int k = 0; k < 3; ++k) {
                link[f[k]].push_back({f[(k + 1) % 3], f[(k + 2) % 3]});
                edge[std::minmax(f[k], f[(k + 1) % 3])].push_back(f);
            }
        }
    }

    /// Kind and ring of a vertex from its definition: walk the graph of link edges.
    Row row(Index v) const {
        Row row;
        std::map<Index, std::vector<Index>> graph;
        for (const auto& [a, b] : link[v]) graph[a].push_back(b), graph[b].push_back(a);
        if (graph.empty()) return row;
        row.kind = RingKind::irregular;
        Index start = graph.begin()->first, ends = 0;
        for (const auto& [a, next] : graph) {
            if (next.size() > 2) return row;
            if (next.size() == 1) start = a, ++ends;
        }
        std::vector<Index> ring;
        std::set<Index> seen;
        for (Index at = start; at >= 0;) {
            ring.push_back(at);
            seen.insert(at);
            Index to = -1;
            for (const Index b : graph[at])
                if (!seen.count(b)) to = b;
            at = to;
        }
        if (ring.size() != graph.size() || (ends == 0 && ring.size() < 3)) return row;
        row.kind = ends == 0 ? RingKind::closed : RingKind::open;
        row.ring = canonical(ring, ends == 0);
        return row;
    }

    /// The other vertex across the edge {a, b} of the face (v, a, b), -1 if there is no or more than one other face.
    Index across(Index v, Index a, Index b) const {
        const auto& faces = edge.at(std::minmax(a, b));
        if (faces.size() != 2) return -1;
        for (const Face& f : faces)
            for (const Index w : f)
                if (w != a && w != b && w != v) return w;
        return -1;
    }

    /// The other end of the open ring of `at`, -1 if it is none.
    Index next_on_boundary(Index from, Index at) const {
        const Row there = row(at);
        if (there.kind != RingKind::open) return -1;
        const Index first = there.ring.front(), last = there.ring.back();
        return first == from ? last : last == from ? first : -1;
    }

    std::vector<std::vector<std::pair<Index, Index>>> link;
    std::map<std::pair<Index, Index>, Faces> edge;
};

void expect_rings_by_definition(const Mesh& mesh) {
    const Rings rings = rings_with_flaps(mesh);
    const Neighbourhoods plain(mesh);
    ASSERT_EQ(rings.rows(), static_cast<Index>(mesh.positions.size()));
    ASSERT_EQ(rings.offset.back(), static_cast<Index>(rings.neighbor.size()));
    for (Index v = 0; v < rings.rows(); ++v) {
        Row row = row_of(rings, v);
        const auto flaps = std::exchange(row.flap, {});
        ASSERT_EQ(row, plain.row(v)) << "vertex " << v;
        for (const auto& [link, flap] : flaps) {
            const auto& [a, b] = link;
            if (a == b) {  // an end of an open row
                ASSERT_EQ(flap, plain.next_on_boundary(v, a)) << "vertex " << v << ", end " << a;
                continue;
            }
            const bool both = rings.size(a) == 0 && rings.size(b) == 0;
            ASSERT_EQ(flap, both ? -1 : plain.across(v, a, b)) << "vertex " << v << ", link " << a << ' ' << b;
        }
    }
}

}  // namespace

TEST(Adjacency, RingsAndFlapsFollowTheirDefinitionOnEveryClass) {
    for (const auto& [name, mesh] : every_class()) {
        SCOPED_TRACE(name);
        expect_rings_by_definition(mesh);
    }
}

TEST(Adjacency, RingsAndFlapsFollowTheirDefinitionOnRandomMeshes) {
    for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        expect_rings_by_definition(fixtures::random_soup(seed));
        if (seed % 10 == 0) expect_rings_by_definition(fixtures::damaged_mesh(seed));
        if (testing::Test::HasFailure()) return;
    }
}

TEST(Adjacency, NeighboursAreMutualAndDistinct) {
    for (const auto& [name, mesh] : every_class()) {
        SCOPED_TRACE(name);
        const Rings rings = vertex_rings(mesh);
        std::set<std::pair<Index, Index>> edges;
        for (Index v = 0; v < rings.rows(); ++v)
            for (Index j = 0; j < rings.size(v); ++j)
                EXPECT_TRUE(edges.insert({v, rings.begin(v)[j]}).second) << v << " has a neighbour twice";
        for (const auto& [a, b] : edges)
            EXPECT_TRUE(edges.count({b, a}) || rings.kind[b] == RingKind::irregular) << a << ' ' << b;
    }
}

TEST(Adjacency, RingsFollowConsistentOrientation) {
    for (const Mesh& mesh : {shapes::scan(400), shapes::plane(8), shapes::torus(5, 4), shapes::open_cylinder(8, 3),
                             shapes::fan(100), shapes::triangle()}) {
        std::set<Face> faces;
        for (const Face& f : mesh.faces)
            for (int k = 0; k < 3; ++k) faces.insert({f[k], f[(k + 1) % 3], f[(k + 2) % 3]});
        const Rings rings = vertex_rings(mesh);
        for (Index v = 0; v < rings.rows(); ++v) {
            const Index d = rings.size(v), triangles = rings.kind[v] == RingKind::closed ? d : d - 1;
            for (Index j = 0; j < triangles; ++j)
                EXPECT_TRUE(faces.count({v, rings.begin(v)[j], rings.begin(v)[(j + 1) % d]})) << v << ", entry " << j;
        }
    }
}

namespace {

Array<RingKind> kinds(const Mesh& mesh) { return vertex_rings(mesh).kind; }

Mesh with_faces(Index vertices, Faces faces) {
    Mesh mesh;
    shapes::Random random(vertices);
    for (Index v = 0; v < vertices; ++v) mesh.positions.push_back(random.direction());
    mesh.faces = std::move(faces);
    return mesh;
}

constexpr RingKind closed = RingKind::closed, open = RingKind::open, irregular = RingKind::irregular,
                   isolated = RingKind::isolated;

}  // namespace

TEST(Adjacency, ClassifiesLiteralMeshes) {
    using Kinds = Array<RingKind>;
    EXPECT_EQ(kinds(shapes::triangle()), (Kinds{open, open, open}));
    EXPECT_EQ(kinds(shapes::tetrahedron()), (Kinds{closed, closed, closed, closed}));
    EXPECT_EQ(kinds(shapes::double_sided_triangle()), (Kinds{irregular, irregular, irregular}));
    // Two triangles that share a vertex, and a vertex in no face.
    EXPECT_EQ(kinds(with_faces(6, {{0, 1, 2}, {0, 3, 4}})), (Kinds{irregular, open, open, open, open, isolated}));
    // Three triangles on the edge 0 1.
    EXPECT_EQ(kinds(with_faces(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}})), (Kinds{irregular, irregular, open, open, open}));
    // A triangle twice, turned: all three edges have two faces, but there is no disk.
    EXPECT_EQ(kinds(with_faces(3, {{0, 1, 2}, {1, 2, 0}})), (Kinds{irregular, irregular, irregular}));
    // Two triangles on an edge, inconsistently oriented.
    EXPECT_EQ(kinds(with_faces(4, {{0, 1, 2}, {0, 1, 3}})), (Kinds{open, open, open, open}));
    // Faces that repeat an index do not count, wherever they are.
    EXPECT_EQ(kinds(with_faces(4, {{0, 0, 3}, {0, 1, 2}, {3, 3, 3}, {2, 1, 2}})), (Kinds{open, open, open, isolated}));
    // The tip of a cone whose rim is pinched: edge 0 1 carries four faces.
    EXPECT_EQ(kinds(with_faces(7, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 4}, {0, 4, 5}, {0, 5, 1}}))[0], irregular);
    // A fan of three with a closed fan beside it, meeting in vertex 0 only.
    EXPECT_EQ(kinds(with_faces(8, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {0, 4, 5}, {0, 5, 6}, {0, 6, 7}}))[0], irregular);
    // No faces at all.
    EXPECT_EQ(kinds(with_faces(2, {})), (Kinds{isolated, isolated}));
    EXPECT_TRUE(kinds(Mesh()).empty());
}

TEST(Adjacency, OnlyTheWeldedVertexOfABowtieIsIrregular) {
    const Array<RingKind> kind = kinds(shapes::bowtie());
    EXPECT_EQ(kind[0], irregular);
    EXPECT_EQ(std::count(kind.begin(), kind.end(), closed), static_cast<std::ptrdiff_t>(kind.size()) - 1);
}

TEST(Adjacency, OnlyTheEndsOfAFinAreIrregular) {
    const Mesh mesh = shapes::three_faces_on_an_edge();
    const Array<RingKind> kind = kinds(mesh);
    for (std::size_t v = 0; v < kind.size(); ++v) {
        const bool on_edge = static_cast<Index>(v) == mesh.faces[0][0] || static_cast<Index>(v) == mesh.faces[0][1];
        EXPECT_EQ(kind[v], on_edge ? irregular : v + 1 == kind.size() ? open : closed) << v;
    }
}

TEST(Adjacency, BandsAreRegularWhateverTheirOrientation) {
    for (const Mesh& mesh : {shapes::moebius_band(), shapes::inconsistent_orientation()})
        for (const RingKind kind : kinds(mesh)) EXPECT_TRUE(kind == closed || kind == open);
    // Every boundary vertex of a band of 24 by 4 quadrilaterals: 48.
    const Array<RingKind> kind = kinds(shapes::moebius_band());
    EXPECT_EQ(std::count(kind.begin(), kind.end(), open), 48);
}

TEST(Adjacency, LargeFansKeepTheirOrder) {
    for (const bool reversed : {false, true}) {
        Mesh mesh = shapes::fan(5000, 0.2);
        if (reversed)
            for (std::size_t f = 0; f < mesh.faces.size(); f += 7) std::swap(mesh.faces[f][1], mesh.faces[f][2]);
        shapes::Random random(3);
        const std::vector<Index> order = fixtures::permutation(5000, random);
        Faces faces;
        for (const Index f : order) faces.push_back(mesh.faces[f]);
        mesh.faces = faces;
        const Row row = row_of(vertex_rings(mesh), 0);
        EXPECT_EQ(row.kind, closed);
        for (Index j = 0; j < 5000; ++j) ASSERT_EQ(row.ring[j], j + 1);
        // Without one face the fan is open and starts or ends at the gap.
        mesh.faces.pop_back();
        EXPECT_EQ(vertex_rings(mesh).kind[0], open);
        EXPECT_EQ(vertex_rings(mesh).size(0), 5000);
        // Without another one it is two fans.
        mesh.faces.erase(mesh.faces.begin() + 1234);
        EXPECT_EQ(vertex_rings(mesh).kind[0], irregular);
    }
}

TEST(Adjacency, RenumberedMeshesHaveRenumberedRings) {
    shapes::Random random(11);
    for (const auto& [name, mesh] : every_class()) {
        SCOPED_TRACE(name);
        Rings rings = vertex_rings(mesh);
        mark_features_by_angle(rings, mesh.positions, 33);
        find_flaps(rings);
        const Index n = rings.rows();
        const std::vector<Index> to = fixtures::permutation(n, random);
        const std::vector<Index> order = fixtures::permutation(static_cast<Index>(mesh.faces.size()), random);
        Mesh other;
        other.positions.resize(n);
        for (Index v = 0; v < n; ++v) other.positions[to[v]] = mesh.positions[v];
        for (const Index f : order) {
            const Face& g = mesh.faces[f];
            const int turn = static_cast<int>(random.bits() % 3);
            other.faces.push_back({to[g[turn]], to[g[(turn + 1) % 3]], to[g[(turn + 2) % 3]]});
        }
        Rings renumbered = vertex_rings(other);
        mark_features_by_angle(renumbered, other.positions, 33);
        find_flaps(renumbered);
        for (Index v = 0; v < n; ++v)
            EXPECT_EQ(row_of(renumbered, to[v]), row_of(rings, v, [&](Index w) { return to[w]; })) << v;
    }
}

TEST(SurfaceRings, TakeDuplicateFacesForOne) {
    const Mesh sphere = shapes::irregular_sphere(300);
    Mesh doubled = sphere;
    for (std::size_t f = 0; f < sphere.faces.size(); ++f) {
        const Face& face = sphere.faces[f];
        if (f % 5 == 0) doubled.faces.push_back(face);
        if (f % 3 == 0) doubled.faces.push_back({face[1], face[0], face[2]});
    }
    const auto count = [](const Rings& rings, RingKind kind) {
        return std::count(rings.kind.begin(), rings.kind.end(), kind);
    };
    EXPECT_GT(count(vertex_rings(doubled), RingKind::irregular), 200);
    const Rings expected = vertex_rings(sphere), found = surface_rings(doubled);
    EXPECT_EQ(found.kind, expected.kind);
    ASSERT_EQ(found.offset, expected.offset);
    for (Index v = 0; v < found.rows(); ++v)  // the same cycles, from wherever they start, in either direction
        for (Index j = 0; j < found.size(v); ++j) {
            const auto next = [&](const Rings& r, Index of, int way) {
                const Index* const begin = r.begin(v);
                const Index at = static_cast<Index>(std::find(begin, begin + r.size(v), of) - begin);
                return begin[(at + way + r.size(v)) % r.size(v)];
            };
            const Index u = found.begin(v)[j], after = next(found, u, 1);
            EXPECT_TRUE(after == next(expected, u, 1) || after == next(expected, u, -1));
        }
    const Rings same = surface_rings(sphere);
    EXPECT_EQ(same.neighbor, expected.neighbor);
    EXPECT_EQ(count(surface_rings(shapes::double_sided_triangle()), RingKind::open), 3);
    EXPECT_EQ(count(surface_rings(shapes::three_faces_on_an_edge()), RingKind::irregular), 2);
}

}  // namespace multires
