#pragma once

#include "denoise/candidates.h"
#include "denoise/noise_classes.h"

namespace multires {

/// The noise as it is assumed for the choice.
struct Assumed {
    std::vector<double> deviation;  ///< #V: along the normals, mesh units, times `factor`
    double factor = 1;              ///< see allowance()
    double certain = 1;             ///< share of the variance that there is at least
    double white = 1;               ///< see SurfaceNoise
    bool within_surface = false;    ///< it shows there, too
    bool stairs = false;            ///< flat parts and creases are noise
    bool large = false;             ///< the mesh: see drop_small()
    int normal_steps = 3;           ///< see normal_steps()
    bool by_kind = true;            ///< two kinds of surface may have a blend each
};

/// The blend that is chosen, and what is expected of it; mesh units.
struct Choice {
    Eigen::VectorXd weights;                   ///< mean of those of the classes
    std::vector<Eigen::VectorXd> of_class;     ///< by noise: see NoiseClasses; or two by the kind of surface
    std::vector<std::array<double, 3>> kinds;  ///< #V: shares of the kinds of surface; empty if there is only one
    double before = 0, after = 0;              ///< mean square error of the heights
    double gain = 0;                           ///< what it falls by at least
    double safe = 1;  ///< share of the best move that gains even with as little noise as is certain
};

/// The convex blend of all_candidates() and the mesh itself with the least estimated risk (risk.h) of the normals, as
/// long as distances gain, too. Where the noise is the same everywhere there are two such blends, each where it has the
/// smaller risk (kinds.h), if that certainly gains. Meshes of more than `whole_up_to` vertices (sample.h) are chosen
/// for on patches.
/// @param patches  how many at most
/// @param tick     called with the fraction done; may throw to stop
/// Cost: linear, that of all candidates twice
Choice choose(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
              const Assumed& noise, const NoiseClasses& classes, Index patches,
              const std::function<void(double)>& tick);

}  // namespace multires
