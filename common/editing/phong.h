#pragma once

#include "base/progress.h"
#include "mesh/mesh.h"

#include <cstdint>

/// Detail over a triangle mesh: base points and heights along a continuous field of normals (J. Vorsatz, L. Kobbelt,
/// "Robust Multi-Band Detail Encoding for Triangular Meshes of Arbitrary Connectivity", VMV 1999, section 2).
namespace multires {

/// How a base point was found.
enum class BaseKind : std::uint8_t {
    inside,   ///< the normal at the base point goes through the point
    border,   ///< the search left the surface: the nearest point of the boundary edge it left across
    nearest,  ///< no such point was found: the nearest one of the surface
};

/// A point over a surface.
struct BasePoint {
    Index face = -1;
    Vec3 weight = Vec3::Zero();  ///< barycentric, in [0, 1], of sum 1: q
    Vec3 detail = Vec3::Zero();  ///< p - q in the frame at q; the third is the height, mesh units. The first two are
                                 ///< rounding for BaseKind::inside
    BaseKind kind = BaseKind::inside;
};

/// A triangle mesh with a unit normal at each vertex (the sum of the areas of its faces), blended over faces as in
/// Phong's shading: N = a N_A + b N_B + c N_C at q = a A + b B + c C.
///
/// The frame at q is (t, N x t, N): N of length 1, and t the part across N of the first side of q's face. Where N is 0
/// it is the face's normal.
class PhongSurface {
public:
    /// @param faces      at least one; indices in range
    /// @param positions  #V by 3, finite
    /// Refers to both, which must outlive it. Cost: linear.
    PhongSurface(const Faces& faces, const Positions& positions);

    const Faces& faces() const { return faces_; }
    const Positions& positions() const { return positions_; }

    Vec3 base(Index face, const Vec3& weight) const;    ///< q
    Vec3 normal(Index face, const Vec3& weight) const;  ///< N, of any length
    const Vec3& vertex_normal(Index v) const { return normal_[v]; }

    /// A point over q: its detail is set, so that place() gives it back to rounding.
    BasePoint over(Index face, const Vec3& weight, const Vec3& p) const;
    /// Where a point lies over this surface, which may be another shape than the one it was found over.
    Vec3 place(const BasePoint& b) const;

private:
    Eigen::Matrix3d frame(Index face, const Vec3& weight) const;

    const Faces& faces_;
    const Positions& positions_;
    Array<Vec3> normal_;
};

/// Weights with (p - q) x N = 0 in the plane of a face, of any sign: F(a, b) = (p - q(a, b)) x N(a, b), a quadratic
/// function, by Gauss-Newton steps from the middle.
/// @param corner, normal  of the face; corners relative to p
/// @returns  false if no root is found
bool phong_root(const Vec3 corner[3], const Vec3 normal[3], Vec3& weight);

struct BasePoints {
    Array<BasePoint> points;
    Index border = 0, nearest = 0;  ///< how many are of these kinds
};

/// The base points of points: from a face on, the search walks across the edge whose weight is most negative, to a face
/// where no weight is. Edges of other than two faces are boundary. A walk that comes to no face it has not seen starts
/// again from the face nearest to the point; if that one ends so too, the nearest point is the base.
/// @param starts  #P faces to start from, -1 or empty: the nearest
/// Cost: a few steps a point; O(log #F) for those without a start. Same for any number of threads.
BasePoints base_points(const PhongSurface& surface, const Positions& points, const Array<Index>& starts,
                       const Progress& progress);

/// One face of each vertex, -1 for vertices without: where to start for points that belong to the vertices.
Array<Index> faces_to_start_from(const Faces& faces, std::size_t vertices);

}  // namespace multires
