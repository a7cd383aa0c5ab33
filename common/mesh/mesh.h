#pragma once

#include "base/array.h"
#include "base/index.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

/// Flat indexed triangle meshes: the only mesh type that common/ computes on.
namespace multires {

using Vec3 = Eigen::Vector3d;
using Positions = Array<Vec3>;      ///< #V by 3, mesh units
using Face = std::array<Index, 3>;  ///< three indices into the positions
using Faces = Array<Face>;          ///< #F by 3

inline bool repeats_an_index(const Face& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; }

/// A triangle mesh. Nothing is promised of the faces but that their indices are valid: they may repeat, share
/// edges more than twice, be degenerate or leave vertices unreferenced.
struct Mesh {
    Positions positions;
    Faces faces;
};

}  // namespace multires
