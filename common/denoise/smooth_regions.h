#pragma once

#include "denoise/lattice.h"
#include "denoise/patch.h"

#include <vector>

namespace multires {

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
/// Cost: O(#F log #F); floods in vain end at eighty times the vertices, or two million
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
