#include "filters/layers/adaptive.h"

#include "base/parallel.h"
#include "measure/distance.h"
#include "measure/triangles.h"
#include "measure/vertex_normals.h"
#include "mesh/adjacency.h"
#include "solvers/conjugate_gradients.h"

#include <algorithm>
#include <cmath>

// Where the vertices of a reconstruction fit the input best.

namespace multires {
namespace {

/// Closest point of an input vertex: a face, its barycentric coordinates and normal.
struct Foot {
    Index face = -1;  ///< -1: does not count
    Vec3 share = Vec3::Zero(), normal = Vec3::Zero();
    double weight = 0;
    double gap = 0;  ///< from the foot to the vertex, along the normal
};

/// The normal at a foot. On an edge or a corner, where several faces are equally close and rounding chooses one, it is
/// the direction of the distance, or (without a distance) what the corners' normals say: the same for all of them.
Vec3 normal_at(const Vec3& share, const Vec3& gap, const Face& f, const Vec3& face_normal,
               const Array<Vec3>& vertex_normal, double length) {
    constexpr double tolerance = 1e-6;
    if (share.minCoeff() > tolerance) return face_normal;
    const double distance = gap.norm();
    if (distance > tolerance * length) return gap / distance;
    Vec3 sum(0, 0, 0);
    for (int k = 0; k < 3; ++k)
        if (share[k] > tolerance) sum += share[k] * vertex_normal[f[k]];
    return sum.norm() > tolerance ? sum.normalized() : face_normal;
}

/// Feet of the input's vertices on a reconstruction.
std::vector<Foot> feet_of(const Mesh& input, const std::vector<double>& area, const Faces& faces, const Positions& at) {
    const SurfaceTree tree(faces, at);
    const Array<Vec3> vertex_normal = vertex_normals(faces, at);
    std::vector<Foot> feet(input.positions.size());
    parallel_chunks(static_cast<Index>(feet.size()), 1024, [&](Index begin, Index end) {
        Index hint = -1;
        for (Index i = begin; i < end; ++i) {
            if (!(area[i] > 0)) continue;
            const SurfaceTree::Hit hit = tree.closest(input.positions[i], hint);
            hint = hit.face;
            const Face& f = faces[hit.face];
            const Vec3 n = area_vector(f, at);
            const double length = n.norm();
            if (!(length > 0)) continue;
            Foot& foot = feet[i];
            foot.face = hit.face;
            foot.share = barycentric(hit.point, at[f[0]], at[f[1]], at[f[2]]);
            const Vec3 gap = input.positions[i] - hit.point;
            foot.normal = normal_at(foot.share, gap, f, n / length, vertex_normal, std::sqrt(length));
            foot.weight = area[i];
            foot.gap = foot.normal.dot(gap);
        }
    });
    return feet;
}

/// Least squares for displacements x of the vertices: the sum over the feet of weight (normal . (B x) - gap)^2, where
/// B x is the displacement of the foot, and stiffness weight_v |x_v|^2 over the vertices. Preconditioned by the
/// diagonal.
class Solver {
public:
    Solver(const Faces& faces, const std::vector<Foot>& feet, const std::vector<std::uint8_t>& fixed, Index vertices)
        : faces_(faces), feet_(feet), fixed_(fixed), diagonal_(vertices, 0) {
        std::vector<double> mass(vertices, 0);
        for (const Foot& foot : feet_)
            if (foot.face >= 0)
                for (int k = 0; k < 3; ++k) {
                    mass[faces_[foot.face][k]] += foot.weight * foot.share[k];
                    diagonal_[faces_[foot.face][k]] += foot.weight * foot.share[k] * foot.share[k];
                }
        double mean = 0;
        for (const double m : mass) mean += m;
        mean /= std::max<Index>(1, vertices);
        constexpr double stiffness = 0.02;
        for (Index v = 0; v < vertices; ++v) {
            spring_.push_back(stiffness * mass[v] + 1e-3 * stiffness * mean);
            diagonal_[v] += spring_[v];
        }
    }

    Positions solve(int steps) const {
        std::vector<double> gap(feet_.size());
        for (std::size_t i = 0; i < gap.size(); ++i) gap[i] = feet_[i].gap;
        Array<double> r(3 * diagonal_.size());
        transpose(gap, r);
        Positions x(diagonal_.size(), Vec3::Zero());
        GradientsOptions options;
        options.tolerance = 1e-4;
        options.most_steps = steps;
        GradientsMemory<double> memory;
        // One system for all coordinates, which normals tie together: a channel of 3 #V rows.
        conjugate_gradients<1, false, double>(
            r, options, [&](const Array<double>& p, Array<double>& q) { apply(p, q); },
            [&](const Array<double>& from, Array<double>& to) {
                for (std::size_t i = 0; i < from.size(); ++i) to[i] = from[i] / std::max(diagonal_[i / 3], 1e-300);
            },
            [&](Index i, const double* change) {
                x[i / 3][i % 3] += *change;
                return *change * *change;
            },
            [](int, double) {}, memory);
        return x;
    }

private:
    /// out = sum over the feet of weight B' normal row, 0 at fixed vertices.
    void transpose(const std::vector<double>& rows, Array<double>& out) const {
        std::fill(out.begin(), out.end(), 0.0);
        for (std::size_t i = 0; i < feet_.size(); ++i) {
            const Foot& foot = feet_[i];
            if (foot.face < 0) continue;
            for (int k = 0; k < 3; ++k) {
                const Index v = faces_[foot.face][k];
                if (!fixed_[v]) Eigen::Map<Vec3>(&out[3 * v]) += foot.weight * foot.share[k] * rows[i] * foot.normal;
            }
        }
    }
    void apply(const Array<double>& p, Array<double>& q) const {
        std::vector<double> rows(feet_.size(), 0);
        parallel_for(static_cast<Index>(rows.size()), [&](Index i) {
            const Foot& foot = feet_[i];
            if (foot.face < 0) return;
            for (int k = 0; k < 3; ++k)
                rows[i] += foot.share[k] * foot.normal.dot(Eigen::Map<const Vec3>(&p[3 * faces_[foot.face][k]]));
        });
        transpose(rows, q);
        for (std::size_t i = 0; i < q.size(); ++i)
            if (!fixed_[i / 3]) q[i] += spring_[i / 3] * p[i];
    }

    const Faces& faces_;
    const std::vector<Foot>& feet_;
    const std::vector<std::uint8_t>& fixed_;
    std::vector<double> diagonal_, spring_;
};

/// Takes displacements back, half by half, until no face turns by more than 60 degrees or shrinks to nothing.
Positions without_flips(const Faces& faces, const Positions& before, Positions move) {
    constexpr int halvings = 6;
    std::vector<std::uint8_t> times(before.size(), 0);
    for (bool again = true; again;) {
        again = false;
        std::vector<std::uint8_t> bad(before.size(), 0);
        for (const Face& f : faces) {
            const Vec3 n = area_vector(f, before);
            const Vec3 a = before[f[0]] + move[f[0]];
            const Vec3 m = (before[f[1]] + move[f[1]] - a).cross(before[f[2]] + move[f[2]] - a);
            const double nn = n.norm(), mm = m.norm();
            if (n.dot(m) >= 0.5 * nn * mm && mm >= 0.2 * nn) continue;
            for (const Index v : f) bad[v] = 1;
        }
        for (std::size_t v = 0; v < bad.size(); ++v) {
            if (!bad[v] || move[v].isZero(0)) continue;
            move[v] = ++times[v] < halvings ? Vec3(move[v] / 2) : Vec3(Vec3::Zero());
            again = true;
        }
    }
    for (std::size_t v = 0; v < move.size(); ++v) move[v] += before[v];
    return move;
}

}  // namespace

Positions fitted(const Mesh& input, const Faces& faces, const Positions& positions,
                 const std::vector<std::uint8_t>& fixed) {
    std::vector<std::uint8_t> stay = fixed;
    const Rings rings = surface_rings({positions, faces});
    for (std::size_t v = 0; v < stay.size(); ++v) stay[v] |= rings.kind[v] != RingKind::closed;
    const std::vector<double> area = area_shares(input.faces, input.positions);
    Positions now = positions;
    constexpr int rounds = 2, steps = 12;
    for (int round = 0; round < rounds; ++round) {
        const std::vector<Foot> feet = feet_of(input, area, faces, now);
        Positions move = Solver(faces, feet, stay, static_cast<Index>(now.size())).solve(steps);
        for (std::size_t v = 0; v < move.size(); ++v) move[v] += now[v] - positions[v];
        now = without_flips(faces, positions, std::move(move));
    }
    return now;
}

}  // namespace multires
