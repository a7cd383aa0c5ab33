#pragma once

#include "filters/filter.h"

#include <string>

namespace multires {

/// Reading what watermark() hid.
struct ReadWatermarkOptions {
    LayerRef original;     ///< the mesh before it was marked
    std::string key;       ///< that of the mark
    std::string expected;  ///< empty, or the message to compare with: 16 hexadecimal digits
};

/// Lays the mesh onto the original (rotation, scale and shift are found), reads the coefficients off the offsets and
/// decodes them. Reports the bits, how sure each is, and the probability that there is no mark of this key.
/// @throws InputError  as all filters; for an original that is none, or too far away
/// Cost: one search for every vertex, and 10^5 to place the mesh.
Result read_watermark(const Inputs& inputs, const ReadWatermarkOptions& options, Session& session);

}  // namespace multires
