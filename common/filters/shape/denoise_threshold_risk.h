#pragma once

#include "base/progress.h"
#include "denoise/within_surface.h"

namespace multires {

/// A surface with Gaussian noise, as far as it has some: what is needed to choose among ways to shrink its details.
class NoisySurface {
public:
    /// Cost: linear, as for surface_noise() and relax_within_surface()
    NoisySurface(const Mesh& mesh, const Progress& progress);

    /// Of the noise along the normals, mesh units; 0 if there is next to none, or if what there is is not spread as
    /// Gaussian noise is: a threshold cannot tell impulses and steps of quantisation from shape.
    double deviation() const { return deviation_; }
    /// The noise is as strong within the surface.
    bool all_directions() const { return all_directions_; }
    /// A surface with hardly any noise, for directions.
    const Positions& smooth() const { return smooth_; }

    /// A sample of the noise, #V by 3. It turns with the mesh.
    const Positions& probe() const { return probe_; }

    /// Mean square errors that are expected, over those of the noise.
    struct Expected {
        double edges = 1;    ///< of the differences along edges, which is what normals are made of
        double heights = 1;  ///< of the positions
    };
    /// Stein's estimate (denoise/risk.h), of the heights along the normals, where all else that moves is an error, or
    /// of the positions if there is noise in all directions.
    /// @param after     positions denoised
    /// @param response  #V by 3: what denoising adds to them if a small multiple of the probe is added to the noise,
    ///                  divided by that multiple
    Expected expected(const Positions& after, const Positions& response) const;

private:
    void make_probe();

    const Mesh& mesh_;
    Neighbours near_;
    double deviation_ = 0;
    bool all_directions_ = false;
    Positions smooth_, probe_;
    Array<Vec3> normal_;
};

}  // namespace multires
