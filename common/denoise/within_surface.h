#pragma once

#include "denoise/noise.h"

namespace multires {

/// How vertices are to move within the surface, which removes noise that goes in all directions and turns back the
/// faces that it folded.
struct WithinSurface {
    Positions smoothing;      ///< #V by 3: shifts that remove the noise
    Positions turning;        ///< #V by 3: shifts that turn folded and thin faces back, after those
    bool noisy = false;       ///< noise goes in all directions; otherwise only folded faces were turned back
    bool perhaps = false;     ///< the sampling looks like it, but may be irregular by nature
    bool likely = false;      ///< the same, with more to say for it
    double before = 0;        ///< RMS error within the surface, estimated: 0 unless `noisy` or `perhaps`
    double after = 0;         ///< the same once `smoothing` is applied
    Eigen::VectorXd weights;  ///< of the low passes that `smoothing` is made of; empty without it
    bool turned = false;      ///< `turning` moves vertices
};

/// Whether there is noise within the surface cannot be seen where the sampling is irregular: it is believed if the
/// places of the vertices are irregular enough, and more noise of the same size would not fold many times as many
/// faces as are folded; where the sampling alone would explain the places, faces within which the surface bends do not
/// count, since coarse shapes are folded there by nature. Noise too weak to fold faces is likely if the places are just
/// as irregular as it makes them. It is then removed by Taubin's low passes within the surface, blended with least
/// estimated risk (as along the normals, see risk.h).
/// @param edge      mean edge length
/// @param as_there  what was found on a sample of this mesh, and is done to all of it; null: it is found here
WithinSurface relax_within_surface(const Faces& faces, const Positions& positions, const Neighbours& near,
                                   const SurfaceNoise& noise, double edge, const WithinSurface* as_there = nullptr);

/// Mean of the squared lengths of the rows; 0 without rows.
double mean_square(const Positions& rows);

}  // namespace multires
