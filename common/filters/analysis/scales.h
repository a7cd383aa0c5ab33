#pragma once

#include "filters/filter.h"

#include <string>
#include <vector>

namespace multires {

constexpr int most_scales = 16;

/// What an attribute of scale_details() holds.
enum class ScaleValues {
    bands,    ///< what each band adds
    heights,  ///< what all up to it add: the height over the low pass, as integral invariants have it
};

struct ScaleOptions {
    int bands = 8;        ///< 1 to most_scales
    double finest = 0;    ///< mesh units: the first band holds what is shorter than that
    double coarsest = 0;  ///< mesh units, > finest: the last band ends there; the limits between are evenly spaced in
                          ///< the logarithm
    ScaleValues values = ScaleValues::bands;
    std::string name = "scale";  ///< letters, digits and _: of the attributes, followed by _1, _2, ...
};

/// The signed detail of every band at every vertex, as new custom attributes NAME_1 (finest) to NAME_n, mesh units
/// along the normal of the coarser low pass, positive on the side the faces look to; and as quality the wavelength in
/// the middle of the band in which the vertex stands out most, by its detail over the RMS detail of the band.
///
/// The low passes are a chain of membranes (scale_space.h) of the kept solver. Solves stop at 1e-2 of the band
/// each: measured, no band is off by more than 0.5 % of its RMS, and the whole takes a third of the time of
/// exact ones.
/// @throws InputError  naming the parameter; see require_usable
/// Cost: a million vertices with 16 bands 8.9 s of processor time, set-up included, and 8 bytes a vertex and band.
Result scale_details(const Layer& layer, const ScaleOptions& options, Session& session);

/// The limits of the bands: finest, ..., coarsest, or coarsest alone for one band.
std::vector<double> scale_limits(const ScaleOptions& options);

}  // namespace multires
