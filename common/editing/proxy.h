#pragma once

#include "base/array.h"
#include "base/progress.h"
#include "mesh/mesh.h"

/// A proxy: a coarse mesh beside a fine one, before and after somebody edited it, and the motion of space that its edit
/// stands for near its surface.
namespace multires {

using Mat3 = Eigen::Matrix3d;

/// Two shapes of one connectivity. Refers to what must outlive it.
struct Proxy {
    const Faces& faces;       ///< at least one; indices in range
    const Positions& before;  ///< #P by 3, finite
    const Positions& after;   ///< #P by 3, finite
};

/// The gradient of the displacement at each vertex of the proxy: a linear map G with e' - e = G e for the edges e
/// around it and n' - n = G n for the normals of its faces, by least squares. Edges count by direction, not by length:
/// a long edge says no more of the motion at the vertex than a short one. A face's normal is n before and the square
/// root of the ratio of its areas long after, so that a uniform scale is one (after Sumner and Popovic, "Deformation
/// Transfer for Triangle Meshes", 2004, section 3). Then twice more with what the neighbours' gradients say of the
/// curvature of the motion taken off, so that e' - e = (G_i + G_j) e / 2, about: that leaves two thirds of the error.
///
/// Exactly zero around vertices that do not move. Exact to rounding for rotations, uniform scales and translations,
/// also on degenerate stars: what those leave open is taken from the affine map that fits the whole proxy best.
/// @returns  #P; zero for vertices without a face
/// Cost: linear.
Array<Mat3> displacement_gradients(const Proxy& proxy);

/// The point of a surface that is nearest to another point.
struct Foot {
    Index face = -1;
    Vec3 weight = Vec3::Zero();  ///< barycentric, in [0, 1], of sum 1
    double squared = 0;          ///< squared distance
};

/// The feet of points on the proxy as it was.
/// Cost: O(log #F) for each point near the surface. Same for any number of threads.
Array<Foot> feet_of(const Positions& points, const Faces& faces, const Positions& positions, const Progress& progress);

/// Barycentric coordinates of the point of a triangle that is closest to p; of one of its sides if it has no area.
Vec3 closest_weights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// How points move: a displacement and its gradient for each.
struct Motion {
    Positions displacement;
    Array<Mat3> gradient;
};

/// The motion of points with feet on a proxy. With barycentric b, corners p_k that move by d_k, gradients G_k and the
/// foot q of a point x,
///
///     G(x) = sum b_k G_k,   u(x) = sum b_k d_k + 1/2 sum b_k G_k (q - p_k) + G(x) (x - q).
///
/// The middle term is what makes it good: between the corners, sum b_k d_k is a chord of the motion, and the parabola
/// over it has half the deviation that the corners' tangents predict. Motions that are quadratic along the surface are
/// reproduced, where interpolated corners alone are exact for linear ones. (Phong tessellation has the same form.)
///
/// Exactly zero at feet on faces whose corners neither move nor have neighbours that do.
Motion motion_at(const Positions& points, const Array<Foot>& feet, const Proxy& proxy, const Array<Mat3>& gradients);

}  // namespace multires
