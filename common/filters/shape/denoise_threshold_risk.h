#pragma once

#include "base/progress.h"
#include "denoise/noise.h"
#include "denoise/within_surface.h"

namespace multires {

/// A surface with Gaussian noise, as far as it has some: what is needed to choose among ways to shrink its details.
class NoisySurface {
public:
    /// Cost: that of denoise_automatically(), if there is noise
    NoisySurface(const Mesh& mesh, const Progress& progress);

    /// Of the noise along the normals, root mean square, mesh units; 0 if it is not certain that there is any.
    double deviation() const { return deviation_; }
    /// The noise is as strong within the surface.
    bool all_directions() const { return all_directions_; }
    /// A surface with hardly any noise, for directions.
    const Positions& smooth() const { return smooth_; }

    /// A sample of the noise, #V by 3. It turns with the mesh.
    const Positions& probe() const { return probe_; }

    /// Mean square errors that are expected, over those of the noise, of a share of the way to the result.
    struct Expected {
        double edges = 1;    ///< of the differences along edges, which is what normals are made of
        double heights = 1;  ///< of the positions
        double share = 0;    ///< so much that both fall even if there is no more noise than there is at least
    };
    /// Stein's estimate (denoise/risk.h), of the heights along the normals, where all else that moves is an error, or
    /// of the positions if there is noise in all directions.
    /// @param after     positions denoised
    /// @param response  #V by 3: what denoising adds to them if a small multiple of the probe is added to the noise,
    ///                  divided by that multiple
    Expected expected(const Positions& after, const Positions& response) const;

    /// Share of the way to the result after which it is nearest to where the surface is likely to be, in distance and
    /// in differences along edges: what automatic denoising makes of it, which tells shape that is taken for noise by
    /// more candidates. 0 to 1.
    double nearest_share(const Positions& after) const;

private:
    void make_probe();
    /// Share of the variance of the noise that there is at least, seen by what is taken out of it.
    double certain(const Positions& after, const Positions& response) const;

    const Mesh& mesh_;
    Neighbours near_;
    double deviation_ = 0;
    SurfaceNoise noise_;
    std::vector<double> deviations_;  ///< #V: along the normals
    bool all_directions_ = false;
    Positions smooth_, probe_, likely_;
    Array<Vec3> normal_;
};

}  // namespace multires
