#include "filters/analysis/feature_lines.h"

#include "base/angles.h"
#include "base/parallel.h"
#include "filters/analysis/line_graph.h"
#include "measure/angle.h"
#include "mesh/validation.h"
#include "normals/face_graph.h"
#include "normals/normal_field.h"

#include <algorithm>

namespace multires {
namespace {

void check(const FeatureLineOptions& o) {
    require(o.strong > 0 && o.strong < 180, "strong must be an angle between 0 and 180 degrees");
    require(o.weak > 0 && o.weak <= o.strong, "weak must be more than 0 and at most strong");
    require(o.shortest >= 0, "shortest must be 0 or more");
}

double degrees_between(const Vec3& a, const Vec3& b) { return degrees(angle_between(a, b)); }

/// The mean normal around a vertex of the faces that look about as `like` does.
Vec3 around(Index vertex, const Vec3& like, const Incidence& at, const Array<Vec3>& normal, double turn) {
    Vec3 sum = Vec3::Zero();
    for (const Index f : at[vertex]) {
        const Vec3& n = normal[f];
        const double cosine = std::max(0.0, turn * n.dot(like));
        sum += cosine * cosine * cosine * cosine * turn * n;
    }
    return sum.isZero() ? like : sum;
}

/// Of the bend around an edge, the share that is at the edge: a third to a half on a surface that is curved evenly, all
/// of it at a crease. Edges count from the first on, and fully from the second.
constexpr double even_share = 0.55, crease_share = 0.8;

/// The least of the angles, degrees, less where the surface bends beside the edge as well; 0 beside faces without a
/// normal.
double weight_of(const MeshEdge& e, const Faces& faces, const Incidence& at, const Array<Vec3>& normal) {
    Vec3 n[2] = {normal[e.face[0]], normal[e.face[1]]};
    if (n[0].isZero() || n[1].isZero()) return 0;
    // Faces that pass the edge in the same direction look to different sides.
    const auto start = [&](int side) { return faces[e.face[side]][e.corner[side]]; };
    const double turn = start(0) == start(1) ? -1 : 1;
    n[1] *= turn;
    const double near = degrees_between(n[0], n[1]);
    const Index across[2] = {faces[e.face[0]][(e.corner[0] + 2) % 3], faces[e.face[1]][(e.corner[1] + 2) % 3]};
    const double far =
        degrees_between(around(across[0], n[0], at, normal, 1), around(across[1], n[1], at, normal, turn));
    if (!(near > 0 && far > 0)) return 0;
    return std::min(near, far) * std::clamp((near / far - even_share) / (crease_share - even_share), 0.0, 1.0);
}

}  // namespace

Result feature_lines(const Layer& layer, const FeatureLineOptions& options, Session& session) {
    require_usable(layer.mesh);
    check(options);
    const Faces& faces = layer.mesh.faces;
    const Index vertices = static_cast<Index>(layer.mesh.positions.size());
    session.progress.report(0, "Denoising the normals");
    const Incidence at = vertex_faces(faces, vertices);
    NormalFieldStats stats;
    const Array<Vec3> normal =
        denoise_normals(faces, layer.mesh.positions, face_graph(faces, at), {}, stats,
                        [&](double done) { session.progress.report(0.05 + 0.75 * done, "Denoising the normals"); });
    session.progress.report(0.8, "Following the lines");
    const std::vector<MeshEdge> edges = edges_of_two_faces(faces);
    std::vector<double> weight(edges.size());
    parallel_for(static_cast<Index>(edges.size()),
                 [&](Index i) { weight[i] = weight_of(edges[i], faces, at, normal); });
    session.progress.report(0.85, "Following the lines");
    const std::vector<std::uint8_t> on = clean_lines(edges, weight, vertices, static_cast<Index>(faces.size()),
                                                     {options.strong, options.weak, options.shortest});
    std::vector<std::uint8_t> by_edge(faces.size(), 0), by_vertex(vertices, 0);
    double count = 0, length = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (!on[i]) continue;
        const MeshEdge& e = edges[i];
        ++count, length += (layer.mesh.positions[e.a] - layer.mesh.positions[e.b]).norm();
        by_vertex[e.a] = by_vertex[e.b] = 1;
        for (int side = 0; side < 2; ++side) by_edge[e.face[side]] |= 1 << e.corner[side];
    }
    Result result;
    result.report.add("edges", static_cast<int>(count));
    result.report.add("vertices", static_cast<int>(std::count(by_vertex.begin(), by_vertex.end(), 1)));
    result.report.add("length", length, "mesh units");
    result.report.add("noise", stats.noise);
    if (options.select == FeatureSelection::edges)
        result.selected_edges = std::move(by_edge);
    else
        result.selected_vertex = std::move(by_vertex);
    return result;
}

}  // namespace multires
