#pragma once

#include "grids/raster.h"

#include <array>
#include <vector>

/// Box-spline wavelets on the triangular lattice (Dreger, Gross, Schlegel, "Construction of Multiresolution Triangular
/// B-Spline Surfaces using Hexagonal Filters").
///
/// The lattice is Z^3 / (1, 1, 1), and the paper's barycentric filters (eq. 16) are three one-dimensional ones after
/// another, along e1, e2 and e3 = -e1 - e2. Each is a low or a high pass: eight subbands, of which every second point
/// in each direction is kept. Subband 4 s1 + 2 s2 + s3 has high passes where s is 1; 0 holds the coefficients of the
/// scaling functions, 1 to 7 those of the seven types of wavelets.
namespace multires {

/// The scaling functions: projections of products of three B-splines.
enum class SplineBasis {
    linear,   ///< of Haar functions: piecewise linear, C0
    quartic,  ///< of linear B-splines with Chui and Wang's wavelets: piecewise quartic, C2
};

constexpr int subbands = 8;

/// One level: the parallelogram that the coefficients cover. Coefficient (0, 0) lies at point (2 first, 2 first) of the
/// finer level.
struct CoarseBox {
    Index first = 0, rows = 0, columns = 0;
};

/// The coefficients whose functions reach a parallelogram of samples, a few more on every side.
CoarseBox coarse_box(SplineBasis basis, Index rows, Index columns);

/// How far from its point, in steps along the lattice, the functions of a coefficient reach.
Index reach(SplineBasis basis);

/// Analysis of one level. The dual functions of the quartic basis have no end (they fall by 0.27 every second point);
/// what lies beyond `margin` of what extended() gives has no part in them.
/// @param samples  of any size; points that are not in the mask do not count
/// @returns        the eight subbands of the coarse box
/// Cost: linear.
std::array<Raster, subbands> analyse(const Raster& samples, const Mask& mask, SplineBasis basis);

/// The samples in a parallelogram from the subbands of its coarse box; subbands that are null count as zero. The
/// inverse of analyse(), up to rounding, whatever the extension.
Raster synthesise(const std::array<const double*, subbands>& bands, SplineBasis basis, Index rows, Index columns);

/// The transpose of synthesise(): inner products of the samples with the functions.
std::array<Raster, subbands> correlate(const Raster& samples, SplineBasis basis);

}  // namespace multires
