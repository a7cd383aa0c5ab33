#pragma once

#include "bands/spline.h"
#include "filters/filter.h"
#include "pyramid/band.h"

#include <memory>
#include <vector>

/// What the calibrated filters of shapes and of attributes share: which bands they keep, by the spline filter of
/// bands/spline.h. A band is the difference of the low passes at its two limits, so bands of gain 1 leave no trace.
namespace multires {

enum class BandMethod {
    pyramid,  ///< gains of the levels of a pyramid: quick to change, with approximate limits
    spline,   ///< calibrated low passes: a limit is the wavelength of which half belongs to either side
};

/// The spline where edges differ so much that no level of a pyramid has a wavelength: edge_spread() above 1.6. The
/// scans at hand have 1.01 to 1.44, tessellations of CAD programs 1.7 to 11: there low passes by the pyramid moved
/// vertices by .04 to .6 of the diagonal, by the spline by .01 to .05 (docs/bands.md).
BandMethod default_method(const Mesh& mesh);

struct Calibration {
    BandMethod method = BandMethod::pyramid;
    LowPassOrder order = LowPassOrder::second;  ///< for spline
    bool measure = false;                       ///< for spline: report the transmission measured on the mesh
};

/// The result is f + the sum over the limits of step (low pass of f at the wavelength - f).
struct Limit {
    double wavelength = 0;  ///< mesh units
    double step = 0;        ///< the gain of the coarser side less that of the finer side
    const char* parameter = "";
};

/// The limits of a band that is multiplied by `gain`; none if that is 1. A finest limit at or beyond the finest wave of
/// the mesh (0, level 0, all vertices) is none. Limits in levels and numbers of vertices are those of the pyramid,
/// which is built for them if it is not kept.
/// @param coarsest  the parameter's name
/// @throws InputError  as band_share()
std::vector<Limit> limits_of(const Layer& layer, const Band& band, double gain, const char* coarsest,
                             const PyramidOptions& pyramid, Session& session, Report& report);

/// The session's spline if it is that of this very shape and these features, a new one otherwise (put into the
/// session). Vertices on feature edges are held. Reports which: solver_reused.
/// @throws InputError  for a mesh that is not usable, and missing marks of features
std::shared_ptr<const Spline> spline_of(const Layer& layer, const FeatureOptions& features, Session& session,
                                        Report& report);

/// Reports and logs the transmission measured at the coarsest limit, for waves of 0.7, 1 and 1.4 cutoffs.
void report_transmission(const Spline& spline, const Mesh& mesh, const Calibration& calibration,
                         const std::vector<Limit>& limits, const Progress& progress, Report& report);

}  // namespace multires
