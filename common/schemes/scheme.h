#pragma once

#include "hierarchy/hierarchy.h"

#include <memory>
#include <vector>

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

/// A field as a transform stores it: the coarsest values, and the details lost from level to level.
struct Coefficients {
    struct Detail {
        Field odd;   ///< aligned with Level::odd
        Field even;  ///< aligned with Level::even; no rows in critically sampled schemes
        /// 1 for rows whose channels 0..2 are in a local frame; empty if none is.
        std::vector<std::uint8_t> odd_framed, even_framed;
        /// Storage::single: the values of `odd` and `even`, whose own are empty; see widened().
        Array<float> odd_single{}, even_single{};
    };
    Field base;                  ///< at places 0..size.back()-1
    std::vector<Detail> detail;  ///< details[k] belongs to levels[k]; 0 is the finest
};

/// How weights and details are kept: as double, or as float in half the memory. Float weights are no less exact ways
/// to predict, so inversion stays exact to rounding; float details invert to 6e-8 of their length.
enum class Storage { wide, single };

/// A detail with its values in `odd` and `even`, however it is stored.
Coefficients::Detail widened(const Coefficients::Detail& detail, int width);

/// Splits any channels into a coarse part and details over a hierarchy, and puts them together again.
///
/// Schemes differ in how they predict; all are exact: synthesise(analyse(f)) gives f back up to rounding. A transform
/// refers to its hierarchy, which must outlive it.
class Transform {
public:
    virtual ~Transform() = default;

    /// @param f  #V rows in order of places; see Field::has_positions
    /// @param storage  of the details
    virtual Coefficients analyse(Field f, Storage storage = Storage::wide) const = 0;

    /// @param gain  one factor per level for its details, finest first; empty: all 1
    /// @param level  where to stop: 0 is the input's level, the number of levels gives the base back
    /// @returns     size[level] rows in order of places
    virtual Field synthesise(const Coefficients& coefficients, const std::vector<double>& gain = {},
                             std::size_t level = 0) const = 0;

    /// The scheme's subdivision: synthesis to the input's level from the values of a level and details of zero.
    /// @param values  size[level] rows in order of places
    /// @param level   0 gives the values back, the number of levels starts at the base
    virtual Field subdivide(const Field& values, std::size_t level) const = 0;
};

/// Copies values from order of input to order of places, and back.
Field to_places(const Hierarchy& hierarchy, const Field& input);
Field to_input(const Hierarchy& hierarchy, const Field& places);
Field field_of(const Positions& positions);
Positions positions_of(const Field& field);
/// positions_of(to_input(...)) without the field between.
Positions positions_in_input(const Hierarchy& hierarchy, const Field& places);

}  // namespace multires
