#pragma once

#include "filters/calibration.h"
#include "filters/channels.h"
#include "filters/region.h"
#include "pyramid/bodies.h"

namespace multires {

/// What becomes of the bands.
enum class BandMode {
    low_pass,   ///< everything finer than the cutoff is removed
    stop_band,  ///< the band is removed
    enhance,    ///< the band is multiplied by the gain
};

/// Bands of attributes: the filters of band_filters.h for functions on the surface (Roy et al. 2003, sections 2.2 and
/// 4.1). The pyramid is that of the geometry, so the scales are those of the mesh, and the one kept with the mesh
/// serves all; details of attributes are plain differences in every scheme. The geometry stays as it is.
///
/// A constant stays exactly as it is. Colours are clamped to 0..255, at the end.
struct AttributeBandOptions {
    AttributeChoice what;  ///< attributes of vertices
    BandMode mode = BandMode::low_pass;
    Band band;                  ///< for stop_band and enhance; its unit and softness hold for the cutoff, too
    double cutoff = 0;          ///< in the band's unit, for low_pass
    double gain = 2;            ///< finite, for enhance
    bool linear_light = false;  ///< see AttributeRelaxationOptions
    Calibration calibration;
    Region region;
    PyramidOptions pyramid;
};

/// @throws InputError  for limits and options out of range, attributes that are missing or not finite, and meshes that
///                     are not usable
/// Cost: building the pyramid, unless it is kept; then O(V) for each channel.
Result filter_attribute_bands(const Layer& layer, const AttributeBandOptions& options, Session& session);

/// Calls `change` with the coefficients of a field, which puts the field together again, in order of places. Channels
/// are shifted by their values at the first vertex meanwhile, so that a constant comes back exactly.
/// @param field  #V rows in order of the input
template <class Change>
Field through_pyramid(const Pyramid& pyramid, const Field& field, const Change& change) {
    const auto shifted = [&](Field f, double sign) {
        for (Index r = 0; r < f.rows(); ++r)
            for (int c = 0; c < f.width; ++c) f.row(r)[c] += sign * field.row(0)[c];
        return f;
    };
    Coefficients coefficients = pyramid.scheme().analyse(to_places(pyramid.hierarchy(), shifted(field, -1)));
    return shifted(to_input(pyramid.hierarchy(), change(coefficients)), 1);
}

}  // namespace multires
