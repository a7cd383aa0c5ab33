#pragma once

#include "denoise/lattice.h"
#include "denoise/noise.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace multires {

using Tick = std::function<void(double, const char*)>;  ///< fraction done, and what is being done; may throw to stop

/// What is known of the noise of a mesh before it is chosen what to do.
struct FoundNoise {
    SurfaceNoise noise;
    bool varies = false;   ///< clearly, from place to place
    bool rounded = false;  ///< it is that of rounding to the lattice
    bool voxels = false;   ///< and the lattice that of voxels
    EvenPlaces even;       ///< if it is rounded, but for voxels; or empty
    Index spikes = 0;
    Positions start;                ///< without impulses
    std::vector<double> deviation;  ///< #V: of the noise along the normals, mesh units
    double along_normals = 0;       ///< root mean square of it
    double certain = 0;             ///< share of its square that there is at least

    /// @param edge  mean edge length
    bool is_certain(double edge) const { return certain * along_normals > 1e-4 * edge; }
    void leave_even_places();  ///< there is no noise to be seen
    /// The noise as it is assumed within the surface.
    SurfaceNoise within(double strength) const {
        SurfaceNoise out = noise;
        out.along_normals = strength * along_normals;
        return out;
    }
};

/// Steps of Taubin's low pass after which the normals serve as directions: the stronger the noise, the more.
int normal_steps(double deviation_in_edges);

/// Creases come back to vertices that were put back into a smooth surface: a few steps of guided normals.
/// @param moves  #V: those vertices; no others move
Positions with_creases(const Faces& faces, const Positions& positions, const Incidence& at,
                       const std::vector<std::uint8_t>& moves);

/// The positions without impulses, unless the surface is rough everywhere.
/// @param[out] spikes  vertices set back
Positions without_impulses(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                           Index& spikes);

/// Standard deviation of the noise along the normals, #V, mesh units, where it is the same everywhere or along an axis.
std::vector<double> deviations(const Faces& faces, const Positions& positions, const Neighbours& near,
                               const SurfaceNoise& noise, double edge);

/// Looks for rounding, noise that varies, impulses, and the same noise everywhere, in this order.
/// @param step   of the lattice that all coordinates lie on
/// @param known  deviation along the normals, mesh units, instead of an estimate
/// @param edge   mean edge length
/// Cost: linear, mostly that of surface_noise()
FoundNoise find_noise(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                      const std::optional<double>& step, const std::optional<double>& known, double edge,
                      const Tick& tick);

}  // namespace multires
