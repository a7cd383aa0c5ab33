#pragma once

#include "filters/original.h"
#include "filters/region.h"

#include <string>

namespace multires {

/// A hidden message of 64 bits in the shape.
struct WatermarkOptions {
    std::string message = "6d756c7469726573";  ///< 16 hexadecimal digits
    std::string key;                           ///< any text; needed to read
    double strength = 0.08;  ///< RMS displacement in percent of the diagonal of the bounding box, in (0, 1]
    Region region;
    RelativeTo relative_to = RelativeTo::current;
};

/// Moves vertices by a smooth field of middle wavelengths whose 280 coefficients are the message, coded against errors,
/// with signs and an order that the key decides (watermark/carriers.h, code.h). The larger of the RMS over vertices and
/// that over the surface is `strength`, in a region that of the field before it is cut down
/// to the region. Meshes of fewer than 560 vertices have fewer coefficients, which is said in the log.
/// @throws InputError  as all filters, for a message that is not 64 bits
/// Cost: 280 passes over the vertices.
Result watermark(const Layer& layer, const WatermarkOptions& options, Session& session);

}  // namespace multires
