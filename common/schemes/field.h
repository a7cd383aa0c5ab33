#pragma once

#include "hierarchy/hierarchy.h"

namespace multires {

/// Channels at vertices, interleaved: row r, channel c is values[r * width + c].
struct Field {
    int width = 3;
    Array<double> values;  ///< #rows by width, row-major
    /// True: channels 0..2 are the positions, and schemes with local frames turn their details with the surface.
    /// False: every channel is a function on the surface (a colour, a quality), for which there is nothing to turn.
    bool has_positions = true;

    Field() = default;
    Field(Index rows, int w) : width(w), values(static_cast<std::size_t>(rows) * w, 0.0) {}
    /// Values to be set by the caller.
    static Field unset(Index rows, int w) {
        Field f;
        f.width = w;
        f.values.resize(static_cast<std::size_t>(rows) * w);
        return f;
    }
    Index rows() const { return static_cast<Index>(values.size() / width); }
    double* row(Index r) { return values.data() + static_cast<std::size_t>(r) * width; }
    const double* row(Index r) const { return values.data() + static_cast<std::size_t>(r) * width; }
};

/// Copies values from order of input to order of places, and back.
Field to_places(const Hierarchy& hierarchy, const Field& input);
Field to_input(const Hierarchy& hierarchy, const Field& places);
Field field_of(const Positions& positions);
Positions positions_of(const Field& field);
/// positions_of(to_input(...)) without the field between.
Positions positions_in_input(const Hierarchy& hierarchy, const Field& places);

}  // namespace multires
