#pragma once

#include "mesh/layer.h"
#include "stream/bytes.h"

#include <functional>
#include <optional>

namespace multires::stream {

class Decoder;

/// Cells of coordinates.
struct Grid {
    Vec3 origin{0, 0, 0};  ///< the middle of the first cell
    double step = 1;       ///< size, mesh units
};

struct EncodeOptions {
    int bits = 12;            ///< of a coordinate, over the longest side of the box; 1 to 24
    bool exact = false;       ///< positions come out bit for bit once all has been read
    bool keep_order = false;  ///< so do the orders of vertices and faces, and which corner of a face is the first
    /// Places that are to have all their vertices and faces before the rest goes beyond a coarse shape; empty: none.
    std::function<bool(const Vec3&)> first = {};
    std::optional<Grid> grid = {};  ///< where the cells are; none: they fill the box
};

/// The mesh of a layer, with the attributes and wedges that the layer holds, as a progressive file (docs/stream.md):
/// whatever it is cut down to, but for the first few bytes, is a mesh, and all of it is the mesh of the layer with
/// coordinates rounded to 2^bits cells.
///
/// Vertices whose surroundings are not a disk or half disk of one orientation cannot be left out: they are in every
/// prefix.
/// @param tick  called now and then with the fraction done; may throw to stop
/// @throws InputError  if options are out of range, or a coordinate is not finite
/// Cost: O(#V log #V); about 4 us a vertex.
Bytes encode(const Layer& layer, const EncodeOptions& options, const std::function<void(double)>& tick = {});

/// The same file with a region first: what a server sends to one who looks at a part. Models learn from bit to bit, so
/// parts of a file cannot be sent in another order; it is written anew.
/// @param whole  that has read all of a file
/// @param first  see EncodeOptions
/// @throws InputError  if it has not
/// Cost: as encode().
Bytes region_first(const Decoder& whole, std::function<bool(const Vec3&)> first);

}  // namespace multires::stream
