#pragma once

#include "filters/filter.h"

namespace multires {

/// Signed distance of a layer to another one, the reference (measure/signed_distance.h), as vertex quality.
struct DifferenceOptions {
    LayerRef layer;         ///< the reference: a surface, open or closed, that is not the layer itself
    double wavelength = 0;  ///< >= 0, mesh units: what varies more finely over the surface is left out; 0: nothing
    double beyond = 0;  ///< >= 0, mesh units: distances above it, on either side, are reported as a share of the area
    PyramidOptions pyramid;  ///< for a wavelength
};

/// Distances are those between the layers as the document shows them: both are placed by their transformations first,
/// and the quality is in the document's unit. It is positive where a vertex lies on the side that the normals of the
/// reference point to; a transformation that mirrors does not turn them over. Layers with the same vertices and the
/// same transformation differ by exactly 0.
///
/// The low pass is that of an attribute (attributes_band.h): through the pyramid of the layer itself, so that the
/// wavelength is in its mesh units, as in all filters.
///
/// Reports rms, mean, largest and smallest difference and the share beyond, by the area around each vertex.
/// @throws InputError  naming the layer: without faces, not finite, or the layer itself; a transformation that is not
///                     finite; for options out of range; see require_usable for the layer
/// Cost: O(log #F') for each vertex, #F' of the reference, and the pyramid if there is a wavelength.
Result difference_to_layer(const Inputs& inputs, const DifferenceOptions& options, Session& session);

}  // namespace multires
