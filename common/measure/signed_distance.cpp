#include "measure/signed_distance.h"

#include "measure/angle.h"
#include "measure/measure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace multires {
namespace {

/// For every vertex the first one at exactly the same place.
std::vector<Index> places(const Positions& positions) {
    const auto n = static_cast<Index>(positions.size());
    std::vector<Index> order(n), place(n);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
        const Vec3 &p = positions[a], &q = positions[b];
        for (int k = 0; k < 3; ++k)
            if (p[k] != q[k]) return p[k] < q[k];
        return a < b;
    });
    for (Index i = 0; i < n; ++i) {
        const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
        place[order[i]] = same ? place[order[i - 1]] : order[i];
    }
    return place;
}

}  // namespace

SignedDistance::SignedDistance(const Faces& faces, const Positions& positions)
    : faces_(faces), positions_(positions), tree_(faces, positions), face_normal_(face_normals(faces, positions)),
      vertex_normal_(positions.size(), Vec3::Zero()), place_(places(positions)), first_(positions.size() + 1, 0) {
    for (const Face& f : faces)
        for (const Index v : f) ++first_[place_[v] + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    star_.resize(first_.back());
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Index v = place_[faces[f][k]];
            star_[next[v]++] = static_cast<Index>(f);
            const Vec3 &p = positions[v], &q = positions[faces[f][(k + 1) % 3]], &r = positions[faces[f][(k + 2) % 3]];
            vertex_normal_[v] += angle_between(q - p, r - p) * face_normal_[f];
        }
}

Vec3 SignedDistance::edge_normal(Index a, Index b) const {
    Vec3 sum = Vec3::Zero();
    for (Index i = first_[a]; i < first_[a + 1]; ++i) {
        const Face& f = faces_[star_[i]];
        if (std::any_of(f.begin(), f.end(), [&](Index v) { return place_[v] == b; })) sum += face_normal_[star_[i]];
    }
    return sum;
}

/// Of the vertex, the edge or the face that the point of the face lies on, up to rounding.
Vec3 SignedDistance::pseudonormal(Index face, const Vec3& closest) const {
    constexpr double on = 1e-9;  // of the lengths at hand
    const Face& f = faces_[face];
    for (const Index v : f)
        if (positions_[v] == closest) return vertex_normal_[place_[v]];
    int nearest = 0;
    double height = std::numeric_limits<double>::infinity(), longest = 0;
    for (int k = 0; k < 3; ++k) {
        const Vec3 &a = positions_[f[k]], side = positions_[f[(k + 1) % 3]] - a;
        const double length = side.norm();
        const double above = length > 0 ? side.cross(closest - a).norm() / length : 0;
        longest = std::max(longest, length);
        if (above < height) height = above, nearest = k;
    }
    return height <= on * longest ? edge_normal(place_[f[nearest]], place_[f[(nearest + 1) % 3]]) : face_normal_[face];
}

SignedDistance::Hit SignedDistance::at(const Vec3& p, Index hint) const {
    const SurfaceTree::Hit hit = tree_.closest(p, hint);
    const Vec3 away = p - hit.point;
    const double length = std::sqrt(hit.squared);
    // Along the face's own normal that decides: an edge's or a vertex's says the same there.
    double side = away.dot(face_normal_[hit.face]);
    if (std::abs(side) < 0.999999 * length) side = away.dot(pseudonormal(hit.face, hit.point));
    return {side < 0 ? -length : length, hit.face};
}

}  // namespace multires
