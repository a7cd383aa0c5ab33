#pragma once

#include "mesh/rings.h"

#include <array>
#include <vector>

namespace multires {

/// One vertex and its ordered 1-ring: a row of Rings, or one made by hand. A view; it owns nothing.
struct Star {
    Index vertex = 0;
    RingKind kind = RingKind::closed;
    Index size = 0;                         ///< number of neighbours
    const Index* neighbor = nullptr;        ///< size, in order around the vertex
    const Index* flap = nullptr;            ///< size, as Rings::flap; or null: no flaps known
    const std::uint8_t* feature = nullptr;  ///< size, 1 for feature spokes; or null: none is
};

/// Row r of some Rings.
inline Star star(const Rings& rings, Index row) {
    const Index at = rings.offset[row];
    return {rings.vertex(row),
            rings.kind[row],
            rings.size(row),
            rings.neighbor.data() + at,
            rings.flap.empty() ? nullptr : rings.flap.data() + at,
            rings.feature.empty() ? nullptr : rings.feature.data() + at};
}

/// Lengths and cotangents of a closed star of n triangles; triangle j has the corners (vertex, neighbour j, neighbour
/// j+1) and the last one closes the ring. Arrays of plain doubles, so that the loops over triangles vectorise.
/// One square root and one division per triangle; memory is reused from star to star.
class StarGeometry {
public:
    StarGeometry() = default;
    StarGeometry(const StarGeometry&) = delete;  // points into its own memory
    StarGeometry& operator=(const StarGeometry&) = delete;
    StarGeometry(StarGeometry&&) = default;
    StarGeometry& operator=(StarGeometry&&) = default;

    /// Reads a star with a closed ring. Triangles with 2 area <= degenerate x (sum of squared edge lengths) get
    /// cotangents of 0 and valid[j] = 0.
    void load(const Star& star, const Positions& positions, double degenerate);

    Index size = 0;
    // #size+1, the last entry repeats the first:
    double* x = nullptr;  ///< spokes: neighbour minus vertex
    double* y = nullptr;
    double* z = nullptr;
    double* square = nullptr;  ///< squared lengths of the spokes
    // #size:
    double* dot = nullptr;    ///< spoke j times spoke j+1
    double* area = nullptr;   ///< twice the area of triangle j
    double* valid = nullptr;  ///< 1, or 0 if triangle j is degenerate
    double* cot0 = nullptr;   ///< cotangents of triangle j at the vertex,
    double* cot1 = nullptr;   ///< at neighbour j,
    double* cot2 = nullptr;   ///< at neighbour j+1
    // #size+1, for the operators:
    std::array<double*, 6> scratch{};
    std::vector<Index> next, previous;

private:
    void reserve(Index size);

    std::vector<double> memory_;
    Index capacity_ = 0;
};

}  // namespace multires
