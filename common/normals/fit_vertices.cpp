#include "normals/normal_field.h"

#include "base/parallel.h"

#include <cmath>

namespace multires {
namespace {

/// A face counts as folded if it is turned from its normal by more than 60 degrees, and as bad if its height is less
/// than about a tenth of an equilateral one's.
bool needs_room(const Face& f, const Positions& p, const Vec3& normal) {
    const Vec3 ab = p[f[1]] - p[f[0]], ac = p[f[2]] - p[f[0]], bc = p[f[2]] - p[f[1]];
    const Vec3 n = ab.cross(ac);
    const double size = n.norm();
    return n.dot(normal) < 0.5 * size || size < 0.0577 * (ab.squaredNorm() + ac.squaredNorm() + bc.squaredNorm());
}

/// Half of the way to the middle of the faces around, within the surface.
Vec3 within_surface(const Vec3& to_middle, const Vec3& normal_sum) {
    const double length = normal_sum.norm();
    if (!(length > 0)) return Vec3::Zero();
    const Vec3 n = normal_sum / length;
    return 0.5 * (to_middle - n * n.dot(to_middle));
}

/// Inside, every neighbour is met twice and cancels out.
bool on_boundary(const Faces& faces, const Incidence& at, const Array<Vec3>& normals, Index v) {
    Index unpaired = 0;
    for (const Index f : at[v])
        for (const Index w : faces[f]) unpaired ^= w == v || normals[f].isZero() ? 0 : w;
    return unpaired != 0;
}

}  // namespace

Positions fit_vertices(const Faces& faces, const Positions& positions, const Incidence& at, const Array<Vec3>& normals,
                       int steps, const std::vector<std::uint8_t>& moves, Slivers slivers) {
    const Index vertices = static_cast<Index>(positions.size()), count = static_cast<Index>(faces.size());
    Positions p = positions, next(positions.size()), centroid(faces.size());
    std::vector<std::uint8_t> crowded(faces.size());
    for (int step = 0; step < steps; ++step) {
        parallel_for(count, [&](Index f) {
            centroid[f] = (p[faces[f][0]] + p[faces[f][1]] + p[faces[f][2]]) / 3;
            crowded[f] = slivers == Slivers::make_room && needs_room(faces[f], p, normals[f]);
        });
        parallel_for(vertices, [&](Index v) {
            next[v] = p[v];
            if (!moves.empty() && !moves[v]) return;
            Vec3 along(0, 0, 0), middle(0, 0, 0), normal_sum(0, 0, 0);
            Index members = 0;
            bool make_room = false;
            for (const Index f : at[v]) {
                if (normals[f].isZero()) continue;
                const Vec3 to = centroid[f] - p[v];
                along += normals[f] * normals[f].dot(to);
                middle += to;
                normal_sum += normals[f];
                make_room |= crowded[f] != 0;
                ++members;
            }
            if (members == 0) return;
            next[v] += along / members;
            // On the boundary, sliding would eat into the mesh.
            if (make_room && !on_boundary(faces, at, normals, v))
                next[v] += within_surface(middle / members - along / members, normal_sum);
        });
        p.swap(next);
    }
    return p;
}

}  // namespace multires
