#include "denoise/within_cells.h"

#include "measure/vertex_normals.h"
#include "normals/face_geometry.h"
#include "normals/normal_field.h"

#include <algorithm>
#include <limits>

namespace multires {
namespace {

constexpr int most_steps = 5, fit_steps = 3;  ///< of the normals, and of fitting to them
constexpr double tolerance = 0.35;            ///< deviation of the weights over differences of normals
constexpr double reach = 1.2;                 ///< of the weights over distances, see spatial_weights()
/// Shares of the variance of rounding at which smoothing ends: texture looks like some of it.
constexpr double most_machined = 1, most_other = 0.9;

/// Mean square of the moves along the normals, by what rounding makes it, of vertices that may move.
double residual(const Faces& faces, const std::vector<std::uint8_t>& moves, const EvenPlaces& even,
                const Positions& rounded, double step, const Positions& p) {
    Array<Vec3> normal = vertex_normals(faces, p);
    keep_in_planes(even, normal);
    double square = 0, expected = 0;
    for (std::size_t v = 0; v < p.size(); ++v) {
        if (moves[v] == 0) continue;
        const double height = normal[v].dot(p[v] - rounded[v]);
        square += height * height;
        expected += normal[v].squaredNorm() * step * step / 12;
    }
    return expected > 0 ? square / expected : 0;
}

Positions smoothed(const Faces& faces, const Incidence& at, const FaceGraph& graph,
                   const std::vector<std::uint8_t>& moves, const EvenPlaces& even, const Positions& rounded,
                   double step, double most, const Positions& start) {
    Positions p = start;
    std::vector<double> spatial;
    double last = residual(faces, moves, even, rounded, step, p), growth = std::numeric_limits<double>::infinity();
    for (int k = 0; k < most_steps; ++k) {
        const FaceGeometry g = face_geometry(faces, p);
        if (k == 0) spatial = spatial_weights(graph, g, reach);
        const Array<Vec3> normal = bilateral_step(graph, spatial, g.area, g.normal, tolerance);
        Positions next = p;
        for (int fit = 0; fit < fit_steps; ++fit) {
            // Within the surface places are known to half a step, too: slivers make no room.
            next = fit_vertices(faces, next, at, normal, 1, moves, Slivers::stay);
            keep_within_cells(even, rounded, step / 2, next);
        }
        const double now = residual(faces, moves, even, rounded, step, next);
        if (now - last > growth) return k == 1 ? start : p;
        if (now > most) return p;
        growth = now - last;
        last = now;
        p.swap(next);
    }
    return p;
}

}  // namespace

void smooth_within_cells(const Faces& faces, const Incidence& at, const FaceGraph& graph,
                         const std::vector<std::uint8_t>& machined, const EvenPlaces& even, const Positions& rounded,
                         double step, double share, Positions& positions) {
    for (const bool creased : {true, false}) {
        std::vector<std::uint8_t> moves(positions.size());
        for (std::size_t f = 0; f < faces.size(); ++f)
            for (const Index v : faces[f]) moves[v] |= static_cast<std::uint8_t>((machined[f] != 0) == creased);
        if (std::find(moves.begin(), moves.end(), 1) == moves.end()) continue;
        const double most = creased ? most_machined : most_other;
        const Positions after = smoothed(faces, at, graph, moves, even, rounded, step, most, positions);
        for (std::size_t v = 0; v < after.size(); ++v) positions[v] += share * (after[v] - positions[v]);
    }
}

}  // namespace multires
