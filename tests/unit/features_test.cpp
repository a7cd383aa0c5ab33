#include "mesh/adjacency.h"

#include "fixtures.h"

#include <cmath>
#include <limits>

namespace multires {
namespace {

using fixtures::every_class;
using fixtures::Row;
using fixtures::row_of;

std::map<std::pair<Index, Index>, Faces> faces_by_edge(const Mesh& mesh) {
    std::map<std::pair<Index, Index>, Faces> edge;
    for (const Face& f : mesh.faces) {
        if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) continue;
        for (int k = 0; k < 3; ++k) edge[std::minmax(f[k], f[(k + 1) % 3])].push_back(f);
    }
    return edge;
}

/// Angle between the normals of the two faces on an edge, oriented alike; NaN if one has no area.
double edge_angle(const Mesh& mesh, const Face& f, const Face& g, Index a, Index b) {
    const auto normal = [&](const Face& h) {
        const Vec3& p = mesh.positions[h[0]];
        const Vec3 n = (mesh.positions[h[1]] - p).cross(mesh.positions[h[2]] - p);
        bool along = false;
        for (int k = 0; k < 3; ++k) along |= h[k] == a && h[(k + 1) % 3] == b;
        return along ? n : Vec3(-n);
    };
    const Vec3 n = normal(f), m = -normal(g);
    if (n.norm() * m.norm() < 1e-12) return std::numeric_limits<double>::quiet_NaN();
    return std::atan2(n.cross(m).norm(), n.dot(m)) * 180 / std::acos(-1.0);
}

void expect_features_by_angle(const Mesh& mesh, double degrees) {
    Rings rings = vertex_rings(mesh);
    mark_features_by_angle(rings, mesh.positions, degrees);
    const auto edges = faces_by_edge(mesh);
    for (Index v = 0; v < rings.rows(); ++v)
        for (Index j = 0; j < rings.size(v); ++j) {
            const Index w = rings.begin(v)[j];
            const Faces& faces = edges.at(std::minmax(v, w));
            const bool marked = rings.feature[rings.offset[v] + j] != 0;
            if (faces.size() != 2) {
                EXPECT_FALSE(marked) << "boundary edge " << v << ' ' << w;
                continue;
            }
            const double angle = edge_angle(mesh, faces[0], faces[1], v, w);
            if (std::isnan(angle) || std::abs(angle - degrees) < 1e-6) continue;  // rounding decides
            EXPECT_EQ(marked, angle > degrees) << v << ' ' << w << ' ' << angle;
        }
}

}  // namespace

TEST(Features, ByAngleAreTheEdgesWhoseNormalsDiffer) {
    for (const auto& [name, mesh] : every_class()) {
        if (name == "coincident_vertices" || name == "collinear_faces") continue;  // normals made of rounding
        SCOPED_TRACE(name);
        for (const double degrees : {3.0, 30.0, 89.0, 120.0}) expect_features_by_angle(mesh, degrees);
    }
}

TEST(Features, BothEndsAgreeToTheLastBit) {
    for (const auto& [name, mesh] : every_class()) {
        SCOPED_TRACE(name);
        // Limits that are the angles of edges of the mesh itself: rounding decides.
        for (const double degrees : {0.001, 10.0, 45.0, 90.0}) {
            Rings rings = vertex_rings(mesh);
            mark_features_by_angle(rings, mesh.positions, degrees);
            std::map<std::pair<Index, Index>, bool> mark;
            for (Index v = 0; v < rings.rows(); ++v)
                for (const auto& [w, marked] : row_of(rings, v).feature) {
                    const auto [at, is_new] = mark.insert({std::minmax(v, w), marked});
                    EXPECT_EQ(at->second, marked) << v << ' ' << w;
                }
        }
    }
}

TEST(Features, NamedEdgesAreMarkedAtBothEndsButNotOnTheBoundary) {
    const Mesh mesh = shapes::two_triangles();  // 0 1 2 and 0 2 3, sharing 0 2
    Rings rings = vertex_rings(mesh);
    mark_features(rings, mesh.faces, {0b101, 0});  // 0 1 (boundary) and 2 0
    for (Index v = 0; v < 4; ++v)
        for (const auto& [w, marked] : row_of(rings, v).feature)
            EXPECT_EQ(marked, std::minmax(v, w) == std::minmax<Index>(0, 2)) << v << ' ' << w;
}

TEST(Features, NamedEdgesAddToThoseByAngle) {
    const Mesh mesh = shapes::block(3);
    Rings by_angle = vertex_rings(mesh);
    mark_features_by_angle(by_angle, mesh.positions, 30);
    Rings both = by_angle;
    std::vector<std::uint8_t> edges(mesh.faces.size(), 0);
    edges[5] = 7;
    mark_features(both, mesh.faces, edges);
    for (Index v = 0; v < both.rows(); ++v) {
        const bool in_face = std::count(mesh.faces[5].begin(), mesh.faces[5].end(), v) > 0;
        const Row before = row_of(by_angle, v), after = row_of(both, v);
        for (const auto& [w, marked] : after.feature) {
            const bool named = in_face && std::count(mesh.faces[5].begin(), mesh.faces[5].end(), w) > 0;
            EXPECT_EQ(marked, named || before.feature.at(w));
        }
    }
}

TEST(Features, FlapsDoNotReachAcrossThem) {
    const Mesh mesh = shapes::block(4);
    Rings rings = vertex_rings(mesh);
    mark_features_by_angle(rings, mesh.positions, 30);
    find_flaps(rings);
    Index across = 0;
    for (Index v = 0; v < rings.rows(); ++v)
        for (const auto& [link, flap] : row_of(rings, v).flap) {
            const bool feature = row_of(rings, link.first).feature.at(link.second);
            EXPECT_EQ(flap < 0, feature);
            across += feature;
        }
    EXPECT_GT(across, 0);
}

}  // namespace multires
