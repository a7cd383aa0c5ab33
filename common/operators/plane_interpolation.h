#pragma once

#include "operators/kernels.h"

#include <array>
#include <vector>

namespace multires::kernels {

/// Interpolation of the values of one closed star in the plane that fits its ring best (total least squares), at the
/// foot of the vertex (Szczesna 2011, "Prediction"). Weights reproduce linear functions of the plane to rounding: what
/// rounding and fallbacks leave is made good by the least change of the ring's weights. Both write #size weights that
/// sum to 1, or return false where there is nothing to interpolate in: rings on a line, rings that have no best plane
/// (as wide across it as along it), rings of more than `most` vertices. Scratch memory is reused.
class PlaneInterpolation {
public:
    static constexpr Index most = 64;

    /// Sibson's weights: the share of the foot's Voronoi cell that each neighbour would have without it. Nonnegative
    /// up to rounding while the foot is inside the ring's convex hull; elsewhere the cell has no end, and the weights
    /// are those of the plane fitted to the values by least squares.
    /// Cost: about n^3 for n natural neighbours, of which there are 4 to 8.
    bool natural_neighbours(const StarGeometry& star, double* weight);

    /// The thin-plate spline through the ring, and through the flaps too if they are given. False also where two of
    /// the ring's vertices are nearer in the plane than a thousandth of the ring's size; flaps that near to others are
    /// left out.
    /// Cost: n^3 / 3 for n vertices.
    bool thin_plate(const StarGeometry& star, const Star& rows, const Flaps* flaps, double* weight);

private:
    struct Point {
        double x, y;
    };
    /// A corner of a convex polygon and what its next side is part of: the bisector to a site, or none (-1).
    struct Corner {
        double x, y;
        Index side;
    };
    using Polygon = std::vector<Corner>;

    bool project(const StarGeometry& star);
    bool cell();
    void make_linear(const Flaps* flaps, double* weight) const;
    void add_flaps(const Star& rows, const Flaps& flaps);
    static void clip(Polygon& polygon, Polygon& scratch, const std::array<double, 3>& line, Index side);
    static double area(const Polygon& polygon);

    Index ring_ = 0;            ///< number of the ring's sites
    std::vector<Point> sites_;  ///< ring, then flaps; the foot is the origin, the ring's radius about 1
    std::vector<Index> entry_;  ///< of the flaps
    Vec3 axis_[2];              ///< of the plane, scaled
    double spread_[2] = {};     ///< of the ring along them
    Point middle_{};            ///< of the ring
    Polygon cell_, part_, scratch_;
    std::vector<double> matrix_, right_;
};

}  // namespace multires::kernels
