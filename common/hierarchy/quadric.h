#pragma once

#include "mesh/mesh.h"

namespace multires {

/// Area-weighted sum of squared distances to planes (Garland and Heckbert 1997), as a function of the offset d from
/// the vertex that owns it: d'Ad + 2b'd + c. Keeping the origin at the vertex avoids cancellation far from zero.
/// Quadric q{} is zero; those of an Array stay unset.
struct Quadric {
    double xx, xy, xz, yy, yz, zz;
    double bx, by, bz, c;

    /// Adds the plane through the owner with normal n (any length): |n| weights the squared distance.
    void add_plane(const Vec3& n, double length) {
        const double s = 1 / length;
        xx += s * n.x() * n.x(), xy += s * n.x() * n.y(), xz += s * n.x() * n.z();
        yy += s * n.y() * n.y(), yz += s * n.y() * n.z(), zz += s * n.z() * n.z();
    }

    /// Adds another quadric whose owner lies at this one's owner + offset.
    void add_moved(const Quadric& q, const Vec3& offset) {
        const Vec3 d = -offset;  // of our owner as seen from theirs
        const Vec3 ad(q.xx * d.x() + q.xy * d.y() + q.xz * d.z(), q.xy * d.x() + q.yy * d.y() + q.yz * d.z(),
                      q.xz * d.x() + q.yz * d.y() + q.zz * d.z());
        c += q.c + d.dot(ad) + 2 * (q.bx * d.x() + q.by * d.y() + q.bz * d.z());
        xx += q.xx, xy += q.xy, xz += q.xz, yy += q.yy, yz += q.yz, zz += q.zz;
        bx += q.bx + ad.x(), by += q.by + ad.y(), bz += q.bz + ad.z();
    }

    double weight() const { return xx + yy + zz; }

    double at(const Vec3& d) const {
        const double x = d.x(), y = d.y(), z = d.z();
        return x * (xx * x + 2 * (xy * y + xz * z + bx)) + y * (yy * y + 2 * (yz * z + by)) + z * (zz * z + 2 * bz) + c;
    }
};

}  // namespace multires
