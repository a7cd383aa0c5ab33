#pragma once

#include "mesh/array.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

/// Flat indexed triangle meshes: the only mesh type that common/ computes on.
namespace multires {

/// Index of a vertex, face or row. 32 bits: meshes hold at most 2^31-1 corners, checked at the boundary.
using Index = std::int32_t;
using Vec3 = Eigen::Vector3d;
using Positions = Array<Vec3>;      ///< #V by 3, mesh units
using Face = std::array<Index, 3>;  ///< three indices into the positions
using Faces = Array<Face>;          ///< #F by 3

/// A triangle mesh. Nothing is promised of the faces but that their indices are valid: they may repeat, share
/// edges more than twice, be degenerate or leave vertices unreferenced.
struct Mesh {
    Positions positions;
    Faces faces;
};

}  // namespace multires
