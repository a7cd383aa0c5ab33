#pragma once

#include "denoise/lattice.h"

#include <array>

namespace multires {

/// A plane, or a height over one that is a polynomial of second degree.
struct Patch {
    Vec3 center, x, y, z;          ///< the axes are orthonormal
    std::array<double, 3> bend{};  ///< z = bend . (x^2, x y, y^2)

    double height(const Vec3& p) const;  ///< over the patch along z
    Vec3 gradient(const Vec3& p) const;  ///< of the height: normal of the patch, not of unit length
};

/// Planes and curved patches that a surface with rounded coordinates is made of. The truth is within half a step of
/// each coordinate, and off the surface by the errors of rounding alone. So a patch is believed where it meets the
/// cells of all vertices of a region, the residuals have the variance of rounding (step^2 / 12), and terms of higher
/// degree turn it by less than half of what it turns the denoised surface. Regions are grown from the flattest faces
/// and fitted again as they grow, as far as this is so (after Besl, Jain 1988). Where residuals of all regions together
/// exceed rounding the surface only resembles patches, and there are none.
struct SmoothRegions {
    std::vector<Index> of_face;  ///< #F: region; -1: none
    std::vector<Patch> patch;    ///< of each region
};

/// @param asked      #F: 1 of faces that may be in regions
/// @param rounded    the vertices as given
/// @param step       lattice_step(rounded)
/// @param positions  denoised as far as is known without patches
/// Cost: O(#F log #F); where regions are not found, up to 600 vertices for every fifty faces
SmoothRegions smooth_regions(const Faces& faces, const Incidence& at, const std::vector<std::uint8_t>& asked,
                             const Positions& rounded, double step, const Positions& positions);

/// Vertices moved into the patches of their faces as far as their cells go: projections on patches and cells in turn.
/// @param share  of the way
void move_into(const SmoothRegions& regions, const Incidence& at, const EvenPlaces& even, const Positions& rounded,
               double step, double share, Positions& positions);

}  // namespace multires
