#pragma once

#include "filters/filter.h"

namespace multires {

/// The smooth function between the selected region and the rest, as vertex quality (editing/falloff.h).
struct FalloffOptions {
    double falloff = 1;  ///< mesh units along the surface, >= 0
};

/// Without a selection the region is the whole layer.
/// @throws InputError  for meshes that are not usable and options out of range
Result falloff_quality(const Layer& layer, const FalloffOptions& options, Session& session);

/// Turns, scales and moves the selected region; the surface around it follows (Guskov et al. 1999, section 4.3).
struct MoveRegionOptions {
    FalloffOptions between;
    Vec3 pivot = Vec3::Zero();        ///< rotation and scale are about this point
    Vec3 axis = Vec3::UnitZ();        ///< of length 1
    double angle = 0;                 ///< degrees, by the right-hand rule
    double scale = 1;                 ///< > 0
    Vec3 translation = Vec3::Zero();  ///< mesh units, after rotation and scale
    /// Detail finer than the falloff turns with the surface around it; otherwise every vertex moves on its own.
    bool details_follow = true;
    bool store_falloff = false;  ///< the falloff as vertex quality
    PyramidOptions pyramid;      ///< for details that follow
};

/// With the falloff t, 1 inside and 0 far away, a point x goes to  pivot + scale^t R(t angle) (x - pivot) + t
/// translation: rotations are interpolated, not displacements. Details that follow: this is done to the layer without
/// what is finer than half the falloff, and the rest is carried along by the change of the surface around each vertex.
/// The region itself moves as a rigid body, and what lies beyond the falloff does not move, bit for bit. A motion
/// that is none gives the layer back bit for bit.
/// @throws InputError  as above, and for a motion without a selection
Result move_region(const Layer& layer, const MoveRegionOptions& options, Session& session);

}  // namespace multires
