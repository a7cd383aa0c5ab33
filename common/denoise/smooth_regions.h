#pragma once

#include "denoise/lattice.h"

#include <array>
#include <vector>

namespace multires {

/// A plane, or a height over one that is a polynomial of second degree.
struct Patch {
    Vec3 center, x, y, z;          ///< the axes are orthonormal
    std::array<double, 3> bend{};  ///< z = bend . (x^2, x y, y^2)

    double height(const Vec3& p) const;  ///< over the patch along z
    Vec3 gradient(const Vec3& p) const;  ///< of the height: normal of the patch, not of unit length
};

/// What is known of the errors of the places given: they were rounded, or there is Gaussian noise along the normals.
class PlaceErrors {
public:
    /// @param step  of the lattice of the coordinates
    static PlaceErrors of_rounding(double step);
    /// @param deviation  #V: where there is much less than elsewhere it is taken for somewhat more
    static PlaceErrors of_noise(std::vector<double> deviation);

    double deviation(Index v) const { return rounded() ? rounding_ : deviation_[v]; }
    double spread() const;  ///< deviation of the square, by its mean
    /// Whether a place may be so high over a patch.
    bool allows(double height, const Vec3& gradient, Index v) const;
    bool rounded() const { return step_ > 0; }
    double step() const { return step_; }

private:
    double step_ = 0, rounding_ = 0;  ///< of the lattice; deviation of a uniform error
    std::vector<double> deviation_;
};

/// Planes and curved patches that a surface is made of, of which places with errors are given. The truth is within half
/// a step of each coordinate that was rounded, or within four deviations of the noise, and off the surface by these
/// errors alone. So a patch is believed where all vertices of a region may be on it, the residuals have the variance of
/// the errors, and terms of higher degree turn it by less than half of what it turns the denoised surface. Regions are
/// grown from the flattest faces and fitted again as they grow, as far as this is so (after Besl, Jain 1988). Where
/// residuals of all regions together exceed the errors the surface only resembles patches, and there are none.
struct SmoothRegions {
    std::vector<Index> of_face;  ///< #F: region; -1: none
    std::vector<Patch> patch;    ///< of each region
};

/// @param asked      #F: 1 of faces that may be in regions
/// @param given      the vertices as given
/// @param positions  denoised as far as is known without patches
/// Cost: O(#F log #F); floods in vain end at forty times the vertices
SmoothRegions smooth_regions(const Faces& faces, const Incidence& at, const std::vector<std::uint8_t>& asked,
                             const Positions& given, const PlaceErrors& errors, const Positions& positions);

/// Vertices moved into the patches of their faces as far as the errors go: projections on patches and on what is within
/// the errors of the places given in turn. Where there is noise a vertex on the border of what is in regions goes the
/// part of the way that its faces in regions are of all.
/// @param even   planes along the axes that coordinates stay in; may be empty
/// @param share  of the way
void move_into(const SmoothRegions& regions, const Incidence& at, const EvenPlaces& even, const Positions& given,
               const PlaceErrors& errors, double share, Positions& positions);

}  // namespace multires
