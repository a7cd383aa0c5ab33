#pragma once

#include "measure/distance.h"

#include <vector>

namespace multires {

/// Distance to a triangle surface with the sign of the side: positive where the normals of its faces (right-hand rule)
/// point to.
///
/// The side is that of the angle-weighted pseudonormal at the closest point: of the face, of the edge (sum of the unit
/// normals of its faces) or of the vertex (sum weighted by the faces' angles there): J. A. Baerentzen, H. Aanaes,
/// "Signed Distance Computation Using the Angle Weighted Pseudonormal", IEEE TVCG 11(3), 2005. It is right at every
/// point for a closed surface that is oriented outwards. Beyond the boundary of an open surface it is the side of the
/// plane across the pseudonormal there, so the sign does not jump where the surface goes on evenly. Vertices at the
/// same place count as one, so it makes no difference whether faces share them.
class SignedDistance {
public:
    /// @param faces      at least one; indices in range
    /// @param positions  #V by 3, finite
    /// Refers to both, which must outlive it. Cost: O(#F log #F).
    SignedDistance(const Faces& faces, const Positions& positions);

    struct Hit {
        double distance = 0;  ///< mesh units; 0 exactly at vertices of the surface
        Index face = -1;      ///< a face at that distance
    };

    /// @param hint  a face that may be near, which only makes the search faster; -1: none
    Hit at(const Vec3& p, Index hint = -1) const;

private:
    Vec3 pseudonormal(Index face, const Vec3& closest) const;
    Vec3 edge_normal(Index a, Index b) const;

    const Faces& faces_;
    const Positions& positions_;
    SurfaceTree tree_;
    Array<Vec3> face_normal_;          // #F by 3
    Array<Vec3> vertex_normal_;        // #V by 3, at the first of the vertices at a place
    std::vector<Index> place_;         // #V, the first vertex at the same place
    std::vector<Index> first_, star_;  // faces around a place
};

}  // namespace multires
