#pragma once

#include "mesh/rings.h"
#include "operators/plane_interpolation.h"
#include "operators/row_sums.h"
#include "operators/star.h"

#include <vector>

/// Relaxation operators R: each predicts a vertex from its neighbours,  R f_v = sum_k weight_k f_k.
///
/// Sign convention of the whole project: the Laplacian is L = R - I, so L f_v = (mean of the neighbours) - f_v. It
/// points towards the neighbours, is negative semidefinite where the weights are nonnegative and symmetrisable, and
/// f + t L f with 0 < t <= 1 smooths. The detail of a vertex is its negative, f_v - R f_v.
///
/// The weights depend on positions only and apply to every channel f (Roy 2003, eq. 3). They do not change under
/// rotation, translation, reflection or scaling of the mesh.
///
/// Rules that hold for all operators
/// - Every row sums to 1 up to rounding, or is identically zero and listed in `fixed`: that vertex keeps its value,
///   R f_v = f_v. Fixed are vertices without a ring (irregular, isolated) and corners (below).
/// - Boundary: a vertex with an open ring is relaxed along the boundary curve only. Operators with flaps minimise
///   the squared second-order differences at the vertex and at its two boundary neighbours, for which they know the
///   next vertices: quadratic functions of the length are reproduced, so that round rims are. Not across corners
///   (mesh/corner.h), to which both sides are carried on: linear functions of the plane are reproduced.
///   The others interpolate linearly between the two neighbours with weights inverse to the edge lengths. The
///   vertex is fixed if a feature edge meets the boundary there.
/// - Holes: where the surface's angle at a boundary vertex is more than 180 degrees, the triangle of the vertex and its
///   two boundary neighbours lies in a hole. It counts as part of the star, which is a closed one then: predictions
///   along the boundary alone take a small hole for a polygon far from its own mean. The two rules are blended from
///   195 to 210 degrees (holes of 24 and 12 equal sides); features switch this off (RelaxationOptions::close_holes).
/// - Feature edges: the second-order differences across them are left out of the sum (Guskov 1999, section 2.3). For
///   the other operators a vertex with exactly two feature spokes is relaxed along the crease as if it were a
///   boundary; with one, or more than two, it is a corner and fixed. A link edge that is a feature is given by a flap
///   that is none (see Rings::flap).
/// - Degenerate triangles, those with 2 area <= `degenerate` x (sum of squared edge lengths), are left out; those that
///   interpolate in a plane know no triangles.
/// - Rows that would magnify rounding, sum_k |weight_k| > `largest_norm`, and closed rings of which nothing is left
///   or that the operator is not made for (see kernels::PlaneInterpolation) get the weights of cotangent_delaunay
///   instead, or, if all triangles are degenerate, weights inverse to the edge lengths (neighbours that coincide with
///   the vertex, if there are any, share the weight). If the vertex has feature spokes it is fixed.
namespace multires {

/// The weight of neighbour j of vertex i, before each row is divided by its sum.
enum class Operator {
    /// 1 for all neighbours. Depends on the connectivity only: moves vertices within a plane. The baseline.
    umbrella,
    /// cot alpha_ij + cot beta_ij (Roy 2003, eq. 2; Meyer et al. 2002). Reproduces linear functions on planar meshes.
    /// Negative where alpha + beta > 180 degrees, and large on slivers.
    cotangent,
    /// The same with angles limited to [smallest_angle, 180 - smallest_angle] and negative sums set to 0. Weights
    /// are in [0, 1], but linear functions are reproduced only where nothing was limited.
    cotangent_clamped,
    /// Cotangent weights of the star after its spokes with alpha + beta > 180 degrees were flipped intrinsically: both
    /// triangles are unfolded, the spoke drops out (weight 0) and its two ring neighbours become consecutive. Weights
    /// are in [0, 1] and linear functions are reproduced on planar meshes. See cotangent.cpp for how this relates to
    /// the intrinsic Delaunay Laplacian of the whole mesh.
    cotangent_delaunay,
    /// Minimises the squared second-order differences over the spokes (Guskov 1999, eq. 1-3 with E1). Reproduces linear
    /// functions on planar meshes. May be negative.
    second_difference,
    /// The same over spokes and link edges (E2, "1-ring with flaps", Guskov's choice): the stencil includes the flap
    /// vertices. May be negative.
    second_difference_flaps,
    /// Sibson's natural neighbour weights of the vertex's foot in the plane that fits its ring best (Szczesna 2011,
    /// "NNI"): the prediction lies above the foot, so that details of positions are normal to the ring. In [0, 1] while
    /// the foot is inside the ring's convex hull. Reproduces linear functions on planar meshes.
    natural_neighbours,
    /// The thin-plate spline over the ring in the same plane, at the foot (Szczesna's "TPS1"). Reproduces linear
    /// functions on planar meshes. May be negative.
    thin_plate,
    /// The same over the ring and the flap vertices, the part of the second ring that Rings know (Szczesna's "TPS2"
    /// takes all of it: on a regular mesh 6 vertices more). May be negative.
    thin_plate_flaps,
};

/// How a relaxation is made.
struct RelaxationOptions {
    Operator op = Operator::cotangent_delaunay;
    /// Triangles with 2 area <= this x (sum of squared edge lengths) count as degenerate. No unit; an equilateral
    /// triangle has 0.29, one with a base of 1 and a height of h << 1 about h / 2.
    double degenerate = 1e-10;
    /// No unit, at least 1: the largest sum of the absolute weights of a row. Nonnegative rows have 1; on scans nearly
    /// all rows of any operator stay below 6. On the slivers of machined parts, and of cracks whose sides nearly touch,
    /// they reach a million, and levels multiply: with 100 a low pass moved vertices of cracked scans by 400 edges.
    double largest_norm = 6;
    /// Closes the stars of boundary vertices across holes, see above.
    bool close_holes = true;
    /// Degrees, for cotangent_clamped: angles nearer than this to 0 or 180 are taken as this far from them.
    double smallest_angle = 1;
};

/// True if the stencil is more than the 1-ring, so that the rings need Rings::flap.
constexpr bool uses_flaps(Operator op) {
    return op == Operator::second_difference_flaps || op == Operator::thin_plate_flaps;
}

/// Weights on the entries of some Rings and, for operators that use them, on their flaps.
struct RingWeights {
    Array<double> weight;       ///< #entries, aligned with Rings::neighbor; zeros in the fixed rows
    Array<double> flap_weight;  ///< #entries, aligned with Rings::flap, or empty; 0 where there is no flap
    std::vector<Index> fixed;   ///< ascending: the rows whose vertex keeps its value
};

/// Room for the weights of all rows, none of them made: RowRelaxation makes them one by one.
/// @throws std::invalid_argument if the operator uses flaps and the rings have none (our bug, not the user's)
RingWeights unset_weights(const Rings& rings, Operator op);

/// The weights of an operator.
/// @param positions  #V by 3, finite, indexed by the vertices that the rings name
/// @throws std::invalid_argument  as unset_weights()
/// Cost: O(entries), parallel over rows; the result does not depend on the number of threads.
RingWeights ring_weights(const Rings& rings, const Positions& positions, const RelaxationOptions& options = {});

/// The share of each row's step, f + share (R f - f), with which steps may be repeated without end: 1 where the weights
/// are nonnegative, 2 / (1 + sum_k |weight_k|) where some are negative. Plain steps of the second-order differences
/// grow without bound on nearly all meshes: a step solves each vertex's row of a symmetric system A with the others
/// kept (Jacobi), which magnifies eigenvectors of D^-1 A with values over 2. With these shares the absolute values of a
/// row of D^-1 A sum to 2, and so no eigenvalue is larger (Gershgorin). Thin plates solve no symmetric system: theirs
/// grow slowly on machined parts.
/// @returns #rows, in (0, 1]
Array<double> stable_steps(const Rings& rings, const RingWeights& weights);

/// View of both, for row_sums().
RowWeights row_weights(const Rings& rings, const RingWeights& weights);

/// R f at the vertices that have a row, f elsewhere.
/// @param f  #V by 3
/// Cost: O(V + entries), parallel over rows; the result does not depend on the number of threads.
Positions relaxed(const Rings& rings, const RingWeights& weights, const Positions& f);

/// The same into an array that holds values already: only vertices with a row are written. For many steps in turn.
/// @param out  #V by 3, not f itself
void relax(const Rings& rings, const RingWeights& weights, const Positions& f, Positions& out);

/// Makes one row at a time, for callers that have no Rings of a whole level. Holds scratch memory that grows with the
/// largest ring seen: reuse it, one object per thread.
class RowRelaxation {
public:
    explicit RowRelaxation(const RelaxationOptions& options);

    /// Writes the weights of a star's entries and flaps.
    /// @param weight       room for star.size
    /// @param flap_weight  the same; null if the operator does not use flaps
    /// @returns false if the vertex keeps its value; the weights are zero then
    bool row(const Star& star, const Positions& positions, double* weight, double* flap_weight);

private:
    enum class Rule { keep, curve, disk };
    struct Curve {
        Rule rule;
        Index a = 0, b = 0;  ///< entries of the two neighbours along the curve, for Rule::curve
    };
    Curve rule(const Star& star) const;
    bool disk(const Star& star, const Positions& positions, double* weight, double* flap_weight);
    void close_hole(const Star& star, const Positions& positions, double* weight, double* flap_weight);
    bool accept(bool found, const Star& star, double* weight, double* flap_weight);

    RelaxationOptions options_;
    double largest_cotangent_;  ///< of smallest_angle
    StarGeometry geometry_;
    kernels::PlaneInterpolation plane_;
    std::vector<double> closed_;  ///< weights of a star closed across a hole
};

}  // namespace multires
