#pragma once

#include "schemes/field.h"

#include <algorithm>
#include <cmath>

namespace multires {

/// Orthonormal axes at a vertex of a surface that turn with it: tangent, bitangent, normal (Guskov et al. 1999, 3.2).
struct Frame {
    Vec3 t{1, 0, 0}, b{0, 1, 0}, n{0, 0, 1};
    double size = 0;  ///< how far points of the ring may move before the frame turns by about a radian; 0: world axes

    Vec3 to_local(const Vec3& v) const { return {t.dot(v), b.dot(v), n.dot(v)}; }
    Vec3 to_world(const Vec3& v) const { return t * v.x() + b * v.y() + n * v.z(); }
};

/// Frame of a 1-ring: normal = area vector of its polygon, tangent = from its middle to the entry with the smallest
/// index. World axes if the ring has no area. Where the ring begins and which way round it goes makes no difference but
/// to the signs of normal and bitangent, so that mirrored meshes have mirrored frames.
/// @param at  gives the position of a vertex
template <class At>
Frame ring_frame(const Index* ring, Index size, const At& at) {
    Frame f;
    if (size < 3) return f;
    const Vec3 origin = at(ring[0]);
    Vec3 area(0, 0, 0), last = at(ring[1]) - origin, sum = last, marked(0, 0, 0);
    double squares = last.squaredNorm();
    Index smallest = ring[0];
    if (ring[1] < smallest) smallest = ring[1], marked = last;
    for (Index j = 2; j < size; ++j) {
        const Vec3 d = at(ring[j]) - origin;
        area += last.cross(d);
        sum += d;
        squares += d.squaredNorm();
        if (ring[j] < smallest) smallest = ring[j], marked = d;
        last = d;
    }
    const double size2 = area.norm(), extent = 2 * (squares - sum.squaredNorm() / size);
    if (!(size2 > 1e-12 * extent)) return f;
    const Vec3 n = area / size2, across = 2 * (marked - sum / size), t = across - n * n.dot(across);
    const double length = t.norm();
    if (!(length * length > 1e-12 * extent)) return f;
    f.size = std::min(size2 / std::sqrt(extent), length);
    f.n = n;
    f.t = t / length;
    f.b = f.n.cross(f.t);
    return f;
}

/// Unit normal of a ring: that of the triangles between it and an origin, which does not matter if the ring is closed.
/// Zero if they have no area.
template <class At>
Vec3 ring_normal(const Index* ring, Index size, const At& at, const Vec3& origin) {
    if (size < 2) return Vec3::Zero();
    Vec3 area(0, 0, 0), last = at(ring[0]) - origin;
    double squares = last.squaredNorm();
    for (Index j = 1; j < size; ++j) {
        const Vec3 d = at(ring[j]) - origin;
        area += last.cross(d);
        squares += d.squaredNorm();
        last = d;
    }
    const double length = area.norm();
    return length > 1e-12 * squares ? Vec3(area / length) : Vec3(Vec3::Zero());
}

/// Frame of row r of some rings over the first three channels of a field.
inline Frame frame_of(const Rings& rings, Index r, const Field& g) {
    return ring_frame(rings.begin(r), rings.size(r), [&](Index v) {
        const double* p = g.row(v);
        return Vec3(p[0], p[1], p[2]);
    });
}

/// Turns channels 0..2 of a detail into a frame.
/// @returns false, and leaves it in the world's axes, if it is longer than half the frame's ring is wide: what rounding
///          turns the frame by would move the vertex by more than it moved the ring, and grow from level to level
inline bool turn_into(const Frame& frame, double* detail) {
    constexpr double limit = 0.5;  // in sizes of the frame
    const Vec3 world(detail[0], detail[1], detail[2]);
    if (!(world.squaredNorm() <= limit * limit * frame.size * frame.size)) return false;
    const Vec3 local = frame.to_local(world);
    std::copy_n(local.data(), 3, detail);
    return true;
}

}  // namespace multires
