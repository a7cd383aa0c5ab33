#pragma once

#include "filters/editing/bases.h"
#include "filters/original.h"
#include "filters/region.h"

#include <array>

namespace multires {

constexpr int most_bands = 8;

/// A surface split into a smooth base and bands of detail over one another, put together with a gain for each.
struct BandsOptions {
    int bands = 5;  ///< 2 to most_bands, the base counted
    BandLevels levels = BandLevels::ratio;
    int vertices = 500;  ///< that the coarsest base keeps; at least those of the pyramid's base
    std::array<double, most_bands - 1> gain = {1, 1, 1, 1, 1, 1, 1};  ///< finest first; bands - 1 of them count
    Region region;
    RelativeTo relative_to = RelativeTo::current;
    PyramidOptions pyramid;
};

/// Every base is the smooth surface through the vertices that the pyramid keeps longest (smooth_base.h), and the
/// details of a band are base points and heights over the Phong field of the next coarser base (editing/phong.h), so
/// that a band follows what the gains do to coarser ones. Gains of 1 leave the layer as it is, bit for bit.
///
/// Reports the vertices kept and the RMS detail of each band, base points that are not on a normal, and the change.
/// @throws InputError  for meshes that are not usable and options out of range
/// Cost: a pyramid, and 20 to 100 steps of conjugate gradients and the base points for each band.
Result apply_bands(const Layer& layer, const BandsOptions& options, Session& session);

/// Adds vertices_kept, rms_detail, border_points and nearest_points.
void report_bands(const Multiband& bands, const std::vector<Index>& kept, Report& report);

}  // namespace multires
