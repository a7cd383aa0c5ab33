#include "filters/analysis/feature_lines.h"

#include "filter_fixtures.h"
#include "filters/analysis/line_graph.h"
#include "fixtures.h"
#include "measure/measure.h"
#include "measure/vertex_normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace multires {

using namespace fixtures;

namespace {

Result lines_of(const Mesh& mesh, const FeatureLineOptions& options = {}) {
    Session session;
    return feature_lines(layer_of(mesh), options, session);
}

std::vector<std::uint8_t> ends(const Faces& faces, const std::vector<std::uint8_t>& edges, std::size_t vertices) {
    std::vector<std::uint8_t> at(vertices, 0);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k)
            if (edges[f] >> k & 1) at[faces[f][k]] = at[faces[f][(k + 1) % 3]] = 1;
    return at;
}

std::vector<std::uint8_t> with_ring(const Faces& faces, const std::vector<std::uint8_t>& marked) {
    std::vector<std::uint8_t> out = marked;
    for (const Face& f : faces)
        if (marked[f[0]] || marked[f[1]] || marked[f[2]])
            for (const Index v : f) out[v] = 1;
    return out;
}

/// Vertices on edges of a clean mesh that bend by more than `degrees`.
std::vector<std::uint8_t> creases(const Mesh& clean, double degrees) {
    const Array<Vec3> normal = face_normals(clean.faces, clean.positions);
    std::vector<std::uint8_t> at(clean.positions.size(), 0);
    for (const MeshEdge& e : edges_of_two_faces(clean.faces))
        if (normal[e.face[0]].dot(normal[e.face[1]]) < std::cos(degrees * 3.14159265 / 180)) at[e.a] = at[e.b] = 1;
    return at;
}

/// Precision and recall within one ring.
double f1(const Faces& faces, const std::vector<std::uint8_t>& found, const std::vector<std::uint8_t>& truth) {
    const auto near_truth = with_ring(faces, truth), near_found = with_ring(faces, found);
    double all = 0, right = 0, wanted = 0, met = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        all += found[i], right += found[i] && near_truth[i];
        wanted += truth[i], met += truth[i] && near_found[i];
    }
    if (!(all > 0 && wanted > 0)) return 0;
    const double precision = right / all, recall = met / wanted;
    return precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0;
}

Mesh noisy(Mesh mesh, double edges, std::uint64_t seed) {
    const Array<Vec3> normal = vertex_normals(mesh.faces, mesh.positions);
    const double size = edges * mean_edge_length(mesh.faces, mesh.positions);
    shapes::Random random(seed);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        double sum = 0;
        for (int k = 0; k < 12; ++k) sum += random.uniform(-0.5, 0.5);
        mesh.positions[i] += size * sum * normal[i];
    }
    return mesh;
}

/// A cube, `n` edges a side, as a block without groove and ramp is not to be had.
Mesh cube(Index n) {
    Mesh mesh;
    const auto side = [&](const Vec3& corner, const Vec3& u, const Vec3& v) {
        const Index first = static_cast<Index>(mesh.positions.size());
        for (Index j = 0; j <= n; ++j)
            for (Index i = 0; i <= n; ++i) mesh.positions.push_back(corner + u * i / n + v * j / n);
        for (Index j = 0; j < n; ++j)
            for (Index i = 0; i < n; ++i) {
                const Index a = first + j * (n + 1) + i;
                mesh.faces.push_back({a, a + 1, a + n + 2});
                mesh.faces.push_back({a, a + n + 2, a + n + 1});
            }
    };
    const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), o(0, 0, 0);
    side(o, y, x), side(z, x, y), side(o, x, z), side(y, z, x), side(o, z, y), side(x, y, z);
    // Weld.
    std::map<std::array<long, 3>, Index> at;
    Mesh out;
    std::vector<Index> number;
    for (const Vec3& p : mesh.positions) {
        const std::array<long, 3> key{std::lround(p.x() * n), std::lround(p.y() * n), std::lround(p.z() * n)};
        const auto [found, fresh] = at.emplace(key, static_cast<Index>(out.positions.size()));
        if (fresh) out.positions.push_back(p);
        number.push_back(found->second);
    }
    for (Face f : mesh.faces) out.faces.push_back({number[f[0]], number[f[1]], number[f[2]]});
    return out;
}

}  // namespace

TEST(FeatureLines, OfACubeAreItsEdges) {
    const Mesh mesh = cube(12);
    const Result r = lines_of(mesh);
    EXPECT_EQ(ends(mesh.faces, *r.selected_edges, mesh.positions.size()), creases(mesh, 45));
    EXPECT_EQ(count(r.report, "edges"), 12 * 12);
    EXPECT_NEAR(number(r.report, "length"), 12, 1e-9);
    FeatureLineOptions o;
    o.select = FeatureSelection::vertices;
    EXPECT_EQ(*lines_of(mesh, o).selected_vertex, creases(mesh, 45));
}

TEST(FeatureLines, OfNoisyPartsAreTheirCreases) {
    for (const std::uint64_t seed : {1, 2})
        for (const Mesh& clean : {shapes::block(20), shapes::block(40), cube(40)}) {
            const Mesh mesh = noisy(clean, 0.1, seed);
            const auto found = ends(mesh.faces, *lines_of(mesh).selected_edges, mesh.positions.size());
            EXPECT_GE(f1(mesh.faces, found, creases(clean, 30)), 0.95) << mesh.positions.size();
        }
}

TEST(FeatureLines, SmoothShapesHaveNone) {
    for (const Mesh& clean : {shapes::irregular_sphere(5000), shapes::torus(100, 40)})
        for (const double noise : {0.0, 0.1}) {
            const Result r = lines_of(noisy(clean, noise, 3));
            EXPECT_LT(count(r.report, "vertices"), 0.005 * clean.positions.size()) << noise;
        }
}

TEST(FeatureLines, ThinRodsHaveNone) {
    // Bends of 33 degrees along the whole rod: as much at every edge, so that none is a line.
    const Mesh rod = shapes::open_cylinder(11, 60, 1, 30);
    for (const double noise : {0.0, 0.05})
        EXPECT_LT(count(lines_of(noisy(rod, noise, 5)).report, "vertices"), 0.05 * rod.positions.size()) << noise;
}

TEST(FeatureLines, DoNotDependOnTheWindingOfFaces) {
    Mesh mesh = noisy(shapes::block(15), 0.05, 4);
    const Result here = lines_of(mesh);
    for (Face& f : mesh.faces) std::swap(f[1], f[2]);  // edges 0 and 2 change places
    const Result there = lines_of(mesh);
    EXPECT_EQ(count(here.report, "edges"), count(there.report, "edges"));
}

TEST(LineGraph, HysteresisBranchesAndGaps) {
    // A strip of triangles whose rungs and rails are edges: the middle row is a line with a gap and a short branch.
    const Mesh mesh = shapes::plane(20, {0, 0, 1});
    const auto edges = edges_of_two_faces(mesh.faces);
    const auto weights = [&](const std::function<double(int, int, int, int)>& f) {
        std::vector<double> w;
        for (const MeshEdge& e : edges) w.push_back(f(e.a % 21, e.a / 21, e.b % 21, e.b / 21));
        return w;
    };
    const auto row = [](int, int ay, int, int by) { return ay == 10 && by == 10; };
    const auto count_on = [&](const std::vector<double>& w, const LineOptions& o) {
        const auto on = clean_lines(edges, w, 441, static_cast<Index>(mesh.faces.size()), o);
        return std::count(on.begin(), on.end(), 1);
    };
    const auto whole =
        weights([&](int a, int b, int c, int d) { return row(a, b, c, d) ? (a == 3 ? 40.0 : 20.0) : 1.0; });
    EXPECT_EQ(count_on(whole, {30, 15, 6}), 20) << "weak edges that hang together with a strong one";
    EXPECT_EQ(count_on(whole, {50, 15, 6}), 0) << "nothing strong";
    const auto gap =
        weights([&](int a, int b, int c, int d) { return row(a, b, c, d) ? (a == 9 || a == 10 ? 8.0 : 40.0) : 1.0; });
    EXPECT_EQ(count_on(gap, {30, 15, 6}), 20) << "a gap of two is closed";
    EXPECT_EQ(count_on(gap, {30, 15, 2}), 18) << "not where only one may be";
    const auto branch = weights([&](int a, int b, int c, int d) {
        return row(a, b, c, d) || (a == 10 && c == 10 && b >= 10 && d <= 13) ? 40.0 : 1.0;
    });
    EXPECT_EQ(count_on(branch, {30, 15, 6}), 20) << "a branch of three is cut";
    EXPECT_EQ(count_on(branch, {30, 15, 3}), 23) << "it is long enough";
}

TEST(FeatureLines, RefuseWhatIsNoAngle) {
    const auto says = [](double strong, double weak, int shortest, const char* what) {
        FeatureLineOptions o;
        o.strong = strong, o.weak = weak, o.shortest = shortest;
        try {
            lines_of(shapes::icosphere(3), o);
            ADD_FAILURE() << what;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
        }
    };
    says(0, 0, 6, "strong");
    says(std::nan(""), 10, 6, "strong");
    says(30, 31, 6, "weak");
    says(30, std::nan(""), 6, "weak");
    says(30, 15, -1, "shortest");
}

}  // namespace multires
