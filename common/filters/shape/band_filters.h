#pragma once

#include "filters/calibration.h"
#include "filters/original.h"
#include "filters/region.h"
#include "pyramid/band.h"

#include <array>

/// Filters that scale details by scale (Guskov et al. 1999, sections 4.1 and 4.2; Roy et al. 2003, section 4.1).
/// All take a layer and give new positions and a report; they throw InputError for bad input or limits.
///
/// What is computed is a function of the shape they start from (see original.h) alone, its limits in percent and the
/// equalizer's bands included. The region decides where that replaces the current shape, and the report compares the
/// two.
///
/// With Calibration::method = spline the bands are differences of calibrated low passes (bands/spline.h): their limits
/// are wavelengths of which half belongs to either side, as steep as the order says; softness has no part in it.
namespace multires {

/// Removes everything finer than `cutoff`.
struct LowPassOptions {
    double cutoff = 0;  ///< in `unit`
    Unit unit = Unit::wavelength;
    double softness = 0;  ///< octaves, for the pyramid
    Calibration calibration;
    Region region;
    RelativeTo relative_to = RelativeTo::current;
    PyramidOptions pyramid;
};
Result low_pass(const Layer& layer, const LowPassOptions& options, Session& session);

/// Multiplies a band by `gain`: 0 removes it (stop-band), more than 1 enhances it.
struct BandOptions {
    Band band;
    double gain = 0;  ///< finite
    Calibration calibration;
    Region region;
    RelativeTo relative_to = RelativeTo::current;
    PyramidOptions pyramid;
};
Result scale_band(const Layer& layer, const BandOptions& options, Session& session);

constexpr int equalizer_bands = 8;

/// Eight gains from fine to coarse. Band i reaches from limit i to limit i+1 of equalizer_limits(); the first one takes
/// in everything finer and the last one everything coarser; by the spline method, up to the last limit, so that the
/// whole keeps its size.
struct EqualizerOptions {
    std::array<double, equalizer_bands> gain{1, 1, 1, 1, 1, 1, 1, 1};  ///< finite
    double softness = 0.5;                                             ///< octaves, for the pyramid
    Calibration calibration;
    Region region;
    RelativeTo relative_to = RelativeTo::current;
    PyramidOptions pyramid;
};
Result equalizer(const Layer& layer, const EqualizerOptions& options, Session& session);

/// Wavelengths (mesh units) between the bands of the equalizer: evenly spaced in the logarithm from that of the mesh to
/// that of a base of `base_vertices`. Needs no pyramid, so that dialogs can show them.
std::array<double, equalizer_bands + 1> equalizer_limits(const Layer& layer, const PyramidOptions& options);

/// Length (or signed normal part) of what a band adds to each vertex, as vertex quality.
struct DetailOptions {
    Band band;
    bool signed_normal = false;  ///< the part along the vertex normal, positive outwards
    PyramidOptions pyramid;
};
Result detail_quality(const Layer& layer, const DetailOptions& options, Session& session);

/// Single-resolution enhancement E p = R^k p + xi (p - R^k p) (Guskov et al. 1999, section 4.2): xi > 1 sharpens,
/// 0 <= xi < 1 smooths. R is taken from the input's geometry and kept for all k steps, which are shorter where they
/// would grow otherwise (stable_steps(), operators/relaxation.h).
struct UnsharpOptions {
    Operator op = Operator::second_difference_flaps;
    int iterations = 10;  ///< k >= 1
    double xi = 2;        ///< finite
    Region region;
    RelativeTo relative_to = RelativeTo::current;
    Features features = Features::none;
    double feature_angle = 40;  ///< degrees
};
Result unsharp(const Layer& layer, const UnsharpOptions& options, Session& session);

}  // namespace multires
