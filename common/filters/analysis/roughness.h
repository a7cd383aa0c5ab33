#pragma once

#include "bands/transmission.h"
#include "filters/filter.h"

namespace multires {

/// What heights are measured from (the F-operation of ISO 25178-2).
enum class RoughnessForm {
    none,   ///< the xy plane: the mesh is a height map that is level already
    plane,  ///< fitted, as the next two
    sphere,
    cylinder,
    low_pass,  ///< the low pass of the shape at l_filter: any shape
};

/// Roughness by the standard: which scales count, and over what.
struct RoughnessOptions {
    RoughnessForm form = RoughnessForm::low_pass;
    double s_filter = 0;  ///< nesting index, mesh units: shorter waves are noise; 0: all count
    double l_filter = 0;  ///< nesting index, mesh units, > s_filter: longer waves are shape; 0 with a form: all count
    LowPassOrder order = LowPassOrder::gaussian;
    bool selected = false;  ///< the faces whose vertices are all in the selection (see Region) instead of all
};

/// Texture parameters of ISO 25178-2, Sa to Sdr, on any mesh (analysis/heights.h); changes nothing.
///
/// With a plane, sphere or cylinder the heights are a function on the fitted form, filtered there: S-filter, then what
/// the L-filter leaves is taken off. A selection is cut out for that. With low_pass the heights are the differences of
/// two low passes of the whole shape (bands/spline.h), with the metric of the smooth surface, along its normals;
/// faces nearer to an open rim than half of l_filter do not count, unless all are.
/// @throws InputError  naming the parameter: filters below two mean edges, not finite or out of order, a form that does
///                     not fit, a selection without a face; see require_usable
Result roughness(const Layer& layer, const RoughnessOptions& options, Session& session);

}  // namespace multires
