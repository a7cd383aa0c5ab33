#include "hierarchy/placement.h"

#include "base/parallel.h"
#include "hierarchy/collapse.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

using collapse::Ring;
using collapse::ring_of;

/// The offset from p[i] to where vertex i goes, at most as long as the longest edge of the ring.
/// @param i           closed ring, no features
/// @param is_child    bool(Index): it was collapsed into i; children are no neighbours of each other
template <class RingOf, class IsChild>
Vec3 offset_of_best_place(Index i, const RingOf& ring_of, const IsChild& is_child, const Positions& p) {
    constexpr double stay = 1e-3;  // of the trace: what is worth staying along directions in which planes say little
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Vec3 b(0, 0, 0), area(0, 0, 0);
    double volume = 0, reach = 0;
    const auto add = [&](const Vec3& x, const Vec3& y, const Vec3& z, double orientation) {
        const Vec3 n = orientation * (y - x).cross(z - x);
        const double length = n.norm(), off = n.dot(x - p[i]);
        if (!(length > 0)) return;
        a += n * (n / length).transpose();
        b += n * (off / length);
        area += n;
        volume += off;
    };
    const Ring ring = ring_of(i);
    for (Index j = 0; j < ring.size; ++j) {
        const Index x = ring.vertex[j];
        add(p[i], p[x], p[ring.after(j)], 1);
        reach = std::max(reach, (p[x] - p[i]).norm());
        if (!is_child(x)) continue;
        const Ring from = ring_of(x);
        const Index at = from.find(i), triangles = from.closed() ? from.size : from.size - 1;
        const double orientation = from.after(at) == ring.before(j) ? 1 : -1;
        for (Index k = 0; k < triangles; ++k)
            if (from.vertex[k] != i && from.after(k) != i) add(p[x], p[from.vertex[k]], p[from.after(k)], orientation);
    }
    if (!(a.trace() > 0)) return Vec3::Zero();
    a.diagonal().array() += stay * a.trace();
    const Eigen::LLT<Eigen::Matrix3d> solver(a);
    Vec3 offset = solver.solve(b);
    const Vec3 normal = solver.solve(area);
    const double slope = area.dot(normal);
    if (slope > 0) offset += normal * ((volume - area.dot(offset)) / slope);
    const double length = offset.norm();
    if (!std::isfinite(length)) return Vec3::Zero();
    return length > reach ? Vec3(offset * (reach / length)) : offset;
}

}  // namespace

void move_vertices(const Rings& before, const Positions& old, const Step& step, double cosine, const Rings& after,
                   Positions& positions) {
    cosine = std::max(cosine, 0.5);  // turned over is not allowed by any limit
    constexpr int halvings = 4;
    constexpr double least_share = 0.1;  // of a face's area
    const auto ring = [&](Index i) { return ring_of(before, i); };
    const Positions start = positions;
    std::vector<std::uint8_t> moves(start.size(), 0);  // how often an offset may still be halved
    parallel_for(before.rows(), [&](Index i) {
        const Index to = step.code[i];
        if (to < 0 || !ring(i).closed() || ring(i).features() != 0) return;
        const auto is_child = [&](Index x) { return step.code[x] < 0 && step.parent[~step.code[x]] == i; };
        const Ring r = ring(i);
        if (!std::any_of(r.vertex, r.vertex + r.size, is_child)) return;
        positions[to] += offset_of_best_place(i, ring, is_child, old);
        moves[to] = halvings;
    });
    const auto spoils = [&](Index i) {
        const Ring r = ring_of(after, i);
        for (Index j = 0; j < r.size; ++j) {
            const Index a = r.vertex[j], b = r.after(j);
            const Vec3 n = (start[a] - start[i]).cross(start[b] - start[i]);
            const Vec3 m = (positions[a] - positions[i]).cross(positions[b] - positions[i]);
            const double nn = n.norm(), mm = m.norm();
            if (n.dot(m) < cosine * nn * mm || mm < least_share * nn) return true;
        }
        return false;
    };
    for (bool again = true; again;) {
        std::vector<std::uint8_t> bad(start.size(), 0);
        parallel_for(after.rows(), [&](Index i) { bad[i] = moves[i] > 0 && spoils(i); });
        again = false;
        for (std::size_t i = 0; i < bad.size(); ++i) {
            if (!bad[i]) continue;
            again = true;
            if (--moves[i] > 0)
                positions[i] = (positions[i] + start[i]) / 2;
            else
                positions[i] = start[i];
        }
    }
}

}  // namespace multires
