#include "filters/placement.h"

#include "base/error.h"

#include <Eigen/Dense>

#include <cmath>
#include <utility>

namespace multires {
namespace {

Positions placed(Positions positions, const Eigen::Matrix4d& m, const std::string& which) {
    if (m.isIdentity(0)) return positions;
    for (Vec3& p : positions) {
        const Eigen::Vector4d q = m * p.homogeneous();
        p = q.head<3>() / q[3];
        require(p.allFinite(), "the transformation of " + which + " is not finite");
    }
    return positions;
}

}  // namespace

Positions in_world(const Layer& layer, const std::string& which) {
    return placed(layer.mesh.positions, layer.to_world, which);
}

Positions from_world(Positions positions, const Layer& layer, const std::string& which) {
    if (layer.to_world.isIdentity(0)) return positions;
    const Eigen::FullPivLU<Eigen::Matrix4d> lu(layer.to_world);
    require(layer.to_world.allFinite() && lu.isInvertible(), "the transformation of " + which + " has no inverse");
    return placed(std::move(positions), lu.inverse(), which);
}

Positions in_layer(const Layer& other, const Layer& layer, const std::string& which) {
    if (other.to_world == layer.to_world) return other.mesh.positions;
    return from_world(in_world(other, which), layer, "the current layer");
}

}  // namespace multires
