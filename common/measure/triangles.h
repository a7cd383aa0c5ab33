#pragma once

#include "measure/vertex_normals.h"
#include "mesh/mesh.h"

#include <algorithm>
#include <vector>

namespace multires {

/// The weights of the corners at a point of a triangle, in [0, 1], of sum 1; thirds if it has no area.
inline Vec3 barycentric(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, n = ab.cross(ac), ap = p - a;
    const double nn = n.squaredNorm();
    if (!(nn > 0)) return Vec3::Constant(1 / 3.0);
    const double v = std::clamp(ap.cross(ac).dot(n) / nn, 0.0, 1.0);
    const double w = std::clamp(ab.cross(ap).dot(n) / nn, 0.0, 1.0 - v);
    return {1 - v - w, v, w};
}

/// A third of the area of the faces around each vertex, however thin they are.
/// @returns  #V, square mesh units
inline std::vector<double> area_shares(const Faces& faces, const Positions& positions) {
    std::vector<double> area(positions.size(), 0);
    for (const Face& f : faces) {
        const double share = area_vector(f, positions).norm() / 6;
        for (const Index v : f) area[v] += share;
    }
    return area;
}

}  // namespace multires
