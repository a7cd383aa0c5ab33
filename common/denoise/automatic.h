#pragma once

#include "denoise/candidates.h"
#include "denoise/within_surface.h"

/// Denoising without a parameter: the noise is measured, and what is done to the mesh is chosen by how far from the
/// truth it is expected to be (risk.h).
namespace multires {

struct AutomaticOptions {
    double strength = 1;              ///< > 0; factor for the deviation of the noise
    std::optional<double> deviation;  ///< of the noise along the normals, mesh units, instead of an estimate
    bool fast = false;                ///< large meshes are measured on patches, too, and chosen for on fewer
};

/// What was found and done, for the report.
struct AutomaticStats {
    Index outliers = 0;                    ///< single vertices far off, put back before all else
    Index spikes = 0;                      ///< vertices found to be impulses and set back first
    double edge = 0;                       ///< mean edge length of the result
    double deviation = 0;                  ///< of the noise along the normals, mesh units
    double least_deviation = 0;            ///< where it is least, by place
    double most_deviation = 0;             ///< where it is largest
    bool varies = false;                   ///< clearly, from place to place
    bool kinds = false;                    ///< two kinds of surface have blends of their own; weights are means
    bool all_directions = false;           ///< the noise was found within the surface too
    double by_edges = 1;                   ///< share of what looked like noise: see SurfaceNoise
    bool axis = false;                     ///< it goes along one axis of space
    double step = 0;                       ///< of the lattice that the coordinates were rounded to, mesh units; 0: none
    Index patches = 0;                     ///< planes and curved patches that vertices were moved into
    bool voxels = false;                   ///< the lattice is that of voxels, the surface their boundary
    double rms_before = 0, rms_after = 0;  ///< estimated distance of the vertices from the truth, mesh units
    Eigen::VectorXd weights;  ///< of all_candidates(); what is left to 1 stays as it is. Empty: nothing was done
};

/// Cost: linear; large meshes are chosen for on patches of them.
/// @param tick  called with the fraction done and what is being done; may throw to stop
Positions denoise_automatically(const Faces& faces, const Positions& positions, const AutomaticOptions& options,
                                AutomaticStats& stats, const std::function<void(double, const char*)>& tick);

}  // namespace multires
