#include "filters/layers/adaptive.h"

#include "base/parallel.h"
#include "measure/distance.h"
#include "measure/triangles.h"
#include "measure/vertex_normals.h"
#include "mesh/adjacency.h"
#include "mesh/incidence.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

// Where the vertices of a reconstruction fit the input best.

namespace multires {
namespace {

/// Closest point of a sample of the input: a face, its barycentric coordinates and normal.
struct Foot {
    Index face = -1;  ///< -1: does not count
    Vec3 share = Vec3::Zero(), normal = Vec3::Zero();
    double weight = 0;
    double gap = 0;  ///< from the foot to the sample, along the normal
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

/// Finds points of a reconstruction close to points of the input.
class Near {
public:
    Near(const Faces& faces, const Positions& at)
        : faces_(faces), at_(at), around_(vertex_faces(faces, static_cast<Index>(at.size()))) {}

    struct Hit {
        Index face = -1;
        Vec3 point = Vec3::Zero();
    };

    /// A point that no face around the corners of its face is closer than. Where p went into a vertex whose faces it
    /// lies on, as nearly all do, that is the closest one; at a small part of the cost of a search of all faces.
    /// @param start  a vertex near p
    Hit operator()(const Vec3& p, Index start) const {
        Hit hit;
        double least = std::numeric_limits<double>::infinity();
        std::array<Index, 16> searched;
        const auto end = [&](std::size_t n) { return searched.begin() + n; };
        std::size_t count = 0;
        for (Index next = start; next >= 0 && count < searched.size();) {
            const auto done = [&](Index v) { return std::find(searched.begin(), end(count), v) != end(count); };
            for (const Index f : around_[next]) {
                const Face& face = faces_[f];
                if (done(face[0]) || done(face[1]) || done(face[2])) continue;
                const Vec3 point = closest_on_triangle(p, at_[face[0]], at_[face[1]], at_[face[2]]);
                const double squared = (point - p).squaredNorm();
                if (!(squared < least)) continue;
                least = squared;
                hit = {f, point};
            }
            searched[count++] = next;
            next = -1;
            if (hit.face >= 0)
                for (const Index v : faces_[hit.face])
                    if (!done(v)) next = v;
        }
        return hit;
    }

private:
    const Faces& faces_;
    const Positions& at_;
    Incidence around_;
};

/// Feet of the centroids of the input's faces, which weigh as their areas.
/// @param into  see fitted()
std::vector<Foot> feet_of(const Mesh& input, const Faces& faces, const Positions& at, const std::vector<Index>& into) {
    const Near near(faces, at);
    const Array<Vec3> vertex_normal = vertex_normals(faces, at);
    std::vector<Foot> feet(input.faces.size());
    parallel_for(static_cast<Index>(feet.size()), [&](Index i) {
        const Face& from = input.faces[i];
        const double area = area_vector(from, input.positions).norm();
        if (!(area > 0)) return;
        const Vec3 sample = (input.positions[from[0]] + input.positions[from[1]] + input.positions[from[2]]) / 3;
        const Near::Hit hit = near(sample, into[from[0]]);
        if (hit.face < 0) return;
        const Face& f = faces[hit.face];
        const Vec3 n = area_vector(f, at);
        const double length = n.norm();
        if (!(length > 0)) return;
        Foot& foot = feet[i];
        foot.face = hit.face;
        foot.share = barycentric(hit.point, at[f[0]], at[f[1]], at[f[2]]);
        const Vec3 gap = sample - hit.point;
        foot.normal = normal_at(foot.share, gap, f, n / length, vertex_normal, std::sqrt(length));
        foot.weight = area;
        foot.gap = foot.normal.dot(gap);
    });
    return feet;
}

/// Displacements x of the vertices that lessen the sum over the feet of weight (gap - normal . (B x))^2, where B x is
/// the displacement of the foot. As shares sum to one, (gap - normal . (B x))^2 is at most the sum over the corners of
/// share (gap - normal . x_corner)^2, which each vertex makes least by itself; steps of less than twice that length
/// lessen the sum, too.
Positions displacements(const Faces& faces, const std::vector<Foot>& feet, const std::vector<std::uint8_t>& fixed) {
    constexpr double stay = 0.03;  // of the trace: what is worth staying along directions in which feet say little
    constexpr double step = 1.5;
    constexpr int steps = 4;
    std::vector<Eigen::Matrix3d> inverse(fixed.size(), Eigen::Matrix3d::Zero());
    for (const Foot& foot : feet) {
        if (foot.face < 0) continue;
        const Eigen::Matrix3d square = foot.weight * foot.normal * foot.normal.transpose();
        for (int k = 0; k < 3; ++k) inverse[faces[foot.face][k]] += foot.share[k] * square;
    }
    parallel_for(static_cast<Index>(inverse.size()), [&](Index v) {
        Eigen::Matrix3d& m = inverse[v];
        const double trace = m.trace();
        if (fixed[v] || !(trace > 0)) {
            m.setZero();
        } else {
            m.diagonal().array() += stay * trace;
            m = Eigen::Matrix3d(m.inverse());
        }
    });
    Positions x(fixed.size(), Vec3::Zero());
    std::vector<double> left(feet.size());
    for (int i = 0; i < steps; ++i) {
        parallel_for(static_cast<Index>(feet.size()), [&](Index j) {
            const Foot& foot = feet[j];
            if (foot.face < 0) return;
            const Face& f = faces[foot.face];
            const Vec3 moved = foot.share[0] * x[f[0]] + foot.share[1] * x[f[1]] + foot.share[2] * x[f[2]];
            left[j] = foot.weight * (foot.gap - foot.normal.dot(moved));
        });
        Positions pull(fixed.size(), Vec3::Zero());
        for (std::size_t j = 0; j < feet.size(); ++j) {
            if (feet[j].face < 0) continue;
            for (int k = 0; k < 3; ++k) pull[faces[feet[j].face][k]] += feet[j].share[k] * left[j] * feet[j].normal;
        }
        parallel_for(static_cast<Index>(x.size()), [&](Index v) { x[v] += step * (inverse[v] * pull[v]); });
    }
    return x;
}

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

Positions fitted(const Mesh& input, const Faces& faces, const Positions& positions, const std::vector<Index>& into,
                 const std::vector<std::uint8_t>& fixed) {
    std::vector<std::uint8_t> stay = fixed;
    const Rings rings = surface_rings({positions, faces});
    for (std::size_t v = 0; v < stay.size(); ++v) stay[v] |= rings.kind[v] != RingKind::closed;
    return without_flips(faces, positions, displacements(faces, feet_of(input, faces, positions, into), stay));
}

}  // namespace multires
