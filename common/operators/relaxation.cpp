#include "operators/relaxation.h"

#include "base/angles.h"
#include "base/parallel.h"
#include "mesh/corner.h"
#include "operators/kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace multires {

namespace {

double length(const Star& star, const Positions& positions, Index entry) {
    return (positions[star.neighbor[entry]] - positions[star.vertex]).norm();
}

/// Linear interpolation between the neighbours a and b: weights inverse to the edge lengths.
void interpolate(const Star& star, const Positions& positions, Index a, Index b, double* weight) {
    const double to_a = length(star, positions, a), to_b = length(star, positions, b), sum = to_a + to_b;
    weight[a] = sum > 0 ? to_b / sum : 0.5;
    weight[b] = sum > 0 ? to_a / sum : 0.5;
}

/// One side of a vertex on a curve.
struct Side {
    Vec3 to = Vec3::Zero();     ///< to the neighbour
    double near = 0, step = 0;  ///< lengths of the edges to the neighbour, and from there to the next vertex
    double even = 0;            ///< 1; less if `step` is less than half of `near`, or at corners; 0: no next vertex

    /// Of the second-order difference at the neighbour, over `step`; bounded by 4 / near.
    double weight(const Side& other) const { return even > 0 ? even * (2 - other.even) / step : 0; }
};

/// The rows of a curve: what of the second-order difference at the vertex itself counts is `own`.
/// @returns  the sum of the absolute weights
double curve_row(const Side (&side)[2], double own, double (&weight)[2], double (&flap_weight)[2]) {
    double sum = own / (side[0].near * side[1].near), norm = 0;
    for (int s = 0; s < 2; ++s) {
        const double near = side[s].near, both = near + side[1 - s].near, far = near + side[s].step;
        const double g = side[s].weight(side[1 - s]);
        weight[s] = own / (near * both) + g / (2 * near);
        flap_weight[s] = -g / (2 * far);
        sum += g * side[s].step / (2 * near * far);
    }
    for (int s = 0; s < 2; ++s) {
        weight[s] /= sum, flap_weight[s] /= sum;
        norm += std::abs(weight[s]) + std::abs(flap_weight[s]);
    }
    return norm;
}

/// Minimises the sum of the squared second-order differences along a curve over the vertex and its neighbours, with
/// weights for which quadratic functions of the length along the curve are reproduced. At a corner (mesh/corner.h) or
/// where it turns by more than 60 degrees, a difference counts less, and not at all from 90 degrees on. Without those
/// at the neighbours linear interpolation is left; without that at the vertex itself both sides are carried on, unless
/// the row would be too large.
/// @returns false, and no weights, if an edge has no length
bool along_curve(const Star& star, const Positions& positions, Index a, Index b, double largest_norm, double* weight,
                 double* flap_weight) {
    const Index end[2] = {a, b};
    Side side[2];
    for (int s = 0; s < 2; ++s) {
        side[s].to = positions[star.neighbor[end[s]]] - positions[star.vertex];
        side[s].near = side[s].to.norm();
        if (!(side[s].near > 0)) return false;
    }
    const double own_turn = turn(-side[0].to, side[1].to);
    double most_even = 0, turn_beside = 0;
    for (int s = 0; s < 2; ++s) {
        const Index to = star.neighbor[end[s]], next = star.flap[end[s]];
        if (next == to || next == star.vertex || next == star.neighbor[end[1 - s]]) continue;
        const Vec3 on = positions[next] - positions[to];
        const double turn_there = turn(side[s].to, on);
        turn_beside = std::max(turn_beside, turn_there);
        side[s].step = on.norm();
        if (!(side[s].step > 0 && turn_there < 1)) continue;
        side[s].even = std::min({1.0, 2 * side[s].step / side[s].near, 2 - 2 * turn_there}) *
                       (1 - corner_share(turn_there, own_turn));
        most_even = std::max(most_even, side[s].even);
    }
    const double own = 1 - most_even * corner_share(own_turn, turn_beside);
    double near[2], far[2];
    if (!(curve_row(side, own, near, far) <= largest_norm)) curve_row(side, 1, near, far);
    for (int s = 0; s < 2; ++s) weight[end[s]] = near[s], flap_weight[end[s]] = far[s];
    return true;
}

/// Share of the closed star in the row of an open one, by the sum of its triangles' angles at the vertex: 0 up to 195
/// degrees, 1 from 210 on, in between by the sine. Multiplies complex numbers: atan2 has other bits on other systems.
double share_of_closed(const Star& star, const Positions& positions) {
    constexpr double least = 0.25881904510252074, most = 0.5;  // sines of 15 and 30 degrees
    const Vec3& at = positions[star.vertex];
    double re = 1, im = 0;
    bool reflex = false;  // the sum is more than 180 degrees
    for (Index j = 0; j + 1 < star.size; ++j) {
        const Vec3 a = positions[star.neighbor[j]] - at, b = positions[star.neighbor[j + 1]] - at;
        const double x = a.dot(b), y = a.cross(b).norm(), length = std::sqrt(x * x + y * y);
        if (!(length > 0)) continue;
        const double turned = (re * x - im * y) / length;
        im = (re * y + im * x) / length;
        re = turned;
        if (reflex && im > 0) return 1;  // more than 360
        reflex = reflex || im < 0;
        if (reflex && (re > 0 || -im >= most)) return 1;
    }
    return reflex ? std::max(0.0, (-im - least) / (most - least)) : 0;
}

/// What is used when all triangles of a star are degenerate. Scaled by the shortest edge, so that the limit of edges of
/// no length is taken exactly: those share the weight.
void inverse_lengths(const StarGeometry& star, double* weight) {
    const Index n = star.size;
    const double least = std::sqrt(*std::min_element(star.square, star.square + n));
    double sum = 0;
    for (Index j = 0; j < n; ++j) {
        const double length = std::sqrt(star.square[j]);
        weight[j] = length > least ? least / length : 1;
        sum += weight[j];
    }
    for (Index j = 0; j < n; ++j) weight[j] /= sum;
}

bool has_feature(const Star& star) {
    return star.feature != nullptr &&
           std::any_of(star.feature, star.feature + star.size, [](auto f) { return f != 0; });
}

bool is_second_difference(Operator op) {
    return op == Operator::second_difference || op == Operator::second_difference_flaps;
}

/// Calls row(relaxation, r) for all rows in parallel and returns those for which it said false, ascending.
template <class Row>
std::vector<Index> for_rows(Index rows, const RelaxationOptions& options, const Row& row) {
    constexpr Index chunk = 512;
    std::vector<std::vector<Index>> fixed((rows + chunk - 1) / chunk);
    parallel_chunks(rows, chunk, [&](Index begin, Index end) {
        RowRelaxation relaxation(options);
        for (Index r = begin; r < end; ++r) {
            if (!row(relaxation, r)) fixed[begin / chunk].push_back(r);
        }
    });
    std::vector<Index> all;
    for (const std::vector<Index>& part : fixed) all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace

RowRelaxation::RowRelaxation(const RelaxationOptions& options)
    : options_(options), largest_cotangent_(1 / std::tan(radians(options.smallest_angle))) {}

RowRelaxation::Curve RowRelaxation::rule(const Star& star) const {
    if (star.kind == RingKind::open) {
        const Index last = star.size - 1;
        const bool crease_ends = star.feature != nullptr &&
                                 std::any_of(star.feature + 1, star.feature + last, [](auto f) { return f != 0; });
        return {crease_ends ? Rule::keep : Rule::curve, 0, last};
    }
    if (star.kind != RingKind::closed) return {Rule::keep};
    if (star.feature == nullptr || is_second_difference(options_.op)) return {Rule::disk};
    Index count = 0, ends[2] = {0, 0};
    for (Index j = 0; j < star.size; ++j) {
        if (star.feature[j] == 0) continue;
        if (count < 2) ends[count] = j;
        ++count;
    }
    if (count == 0) return {Rule::disk};
    return {count == 2 ? Rule::curve : Rule::keep, ends[0], ends[1]};
}

bool RowRelaxation::row(const Star& star, const Positions& positions, double* weight, double* flap_weight) {
    if (flap_weight != nullptr) std::fill_n(flap_weight, star.size, 0.0);
    const Curve curve = rule(star);
    if (curve.rule == Rule::disk) return disk(star, positions, weight, flap_weight);
    std::fill_n(weight, star.size, 0.0);
    if (curve.rule == Rule::keep) return false;
    const bool open = star.kind == RingKind::open;
    if (!(open && flap_weight != nullptr &&
          along_curve(star, positions, curve.a, curve.b, options_.largest_norm, weight, flap_weight)))
        interpolate(star, positions, curve.a, curve.b, weight);
    if (open && options_.close_holes && !has_feature(star)) close_hole(star, positions, weight, flap_weight);
    return true;
}

void RowRelaxation::close_hole(const Star& star, const Positions& positions, double* weight, double* flap_weight) {
    const double share = share_of_closed(star, positions);
    if (!(share > 0)) return;
    Star closed = star;
    closed.kind = RingKind::closed;
    closed.flap = nullptr;  // unknown inside
    closed_.resize(star.size);
    disk(closed, positions, closed_.data(), nullptr);
    for (Index k = 0; k < star.size; ++k) {
        weight[k] += share * (closed_[k] - weight[k]);
        if (flap_weight != nullptr) flap_weight[k] *= 1 - share;
    }
}

/// @param flap_weight  zeros, or null: the star's flaps are unknown
bool RowRelaxation::disk(const Star& star, const Positions& positions, double* weight, double* flap_weight) {
    if (options_.op == Operator::umbrella) {
        std::fill_n(weight, star.size, 1.0 / star.size);
        return true;
    }
    geometry_.load(star, positions, options_.degenerate);
    const kernels::Flaps flaps{star.flap, &positions, positions[star.vertex], options_.degenerate, flap_weight};
    bool found = false;
    switch (options_.op) {
    case Operator::cotangent:
        found = kernels::cotangent(geometry_, weight);
        break;
    case Operator::cotangent_clamped:
        found = kernels::cotangent_clamped(geometry_, largest_cotangent_, weight);
        break;
    case Operator::cotangent_delaunay:
        found = kernels::cotangent_delaunay(geometry_, weight);
        break;
    case Operator::second_difference:
        found = kernels::second_difference(geometry_, star.feature, nullptr, weight);
        break;
    case Operator::second_difference_flaps:
        found = kernels::second_difference(geometry_, star.feature, flap_weight != nullptr ? &flaps : nullptr, weight);
        break;
    case Operator::natural_neighbours:
        found = plane_.natural_neighbours(geometry_, weight);
        break;
    case Operator::thin_plate:
        found = plane_.thin_plate(geometry_, star, nullptr, weight);
        break;
    case Operator::thin_plate_flaps:
        found = plane_.thin_plate(geometry_, star, flap_weight != nullptr ? &flaps : nullptr, weight);
        break;
    case Operator::umbrella:
        break;  // done above
    }
    return accept(found, star, weight, flap_weight);
}

bool RowRelaxation::accept(bool found, const Star& star, double* weight, double* flap_weight) {
    if (found) {
        double norm = 0;
        for (Index k = 0; k < star.size; ++k) norm += std::abs(weight[k]);
        if (flap_weight != nullptr)
            for (Index k = 0; k < star.size; ++k) norm += std::abs(flap_weight[k]);
        if (norm <= options_.largest_norm) return true;
    }
    std::fill_n(weight, star.size, 0.0);
    if (flap_weight != nullptr) std::fill_n(flap_weight, star.size, 0.0);
    if (has_feature(star)) return false;
    // Once only: flips change the geometry.
    if (options_.op == Operator::cotangent_delaunay || !kernels::cotangent_delaunay(geometry_, weight))
        inverse_lengths(geometry_, weight);
    return true;
}

RingWeights unset_weights(const Rings& rings, Operator op) {
    if (uses_flaps(op) && rings.flap.size() != rings.neighbor.size())
        throw std::invalid_argument("ring_weights: the rings have no flaps");
    RingWeights result;
    result.weight.resize(rings.neighbor.size());
    if (uses_flaps(op)) result.flap_weight.resize(rings.neighbor.size());
    return result;
}

RingWeights ring_weights(const Rings& rings, const Positions& positions, const RelaxationOptions& options) {
    const bool flaps = uses_flaps(options.op);
    RingWeights result = unset_weights(rings, options.op);
    result.fixed = for_rows(rings.rows(), options, [&](RowRelaxation& relaxation, Index r) {
        const Index at = rings.offset[r];
        return relaxation.row(star(rings, r), positions, result.weight.data() + at,
                              flaps ? result.flap_weight.data() + at : nullptr);
    });
    return result;
}

Array<double> stable_steps(const Rings& rings, const RingWeights& weights) {
    Array<double> step(rings.rows());
    parallel_for(rings.rows(), [&](Index r) {
        double norm = 0;
        for (Index k = rings.offset[r]; k < rings.offset[r + 1]; ++k) norm += std::abs(weights.weight[k]);
        if (!weights.flap_weight.empty())
            for (Index k = rings.offset[r]; k < rings.offset[r + 1]; ++k) norm += std::abs(weights.flap_weight[k]);
        step[r] = norm > 1 + 1e-12 ? 2 / (1 + norm) : 1;
    });
    return step;
}

RowWeights row_weights(const Rings& rings, const RingWeights& weights) {
    return {&rings, weights.weight.data(), weights.flap_weight.empty() ? nullptr : weights.flap_weight.data()};
}

void relax(const Rings& rings, const RingWeights& weights, const Positions& f, Positions& out) {
    if (rings.rows() == 0) return;
    const RowWeights rows = row_weights(rings, weights);
    const double* const from = f.data()->data();
    if (rings.vertices.empty())
        parallel_chunks(rings.rows(), 8192, [&](Index begin, Index end) {
            row_sums(rows, begin, end, from, 3, out[rings.first + begin].data());
        });
    else
        parallel_chunks(rings.rows(), 512, [&](Index begin, Index end) {
            std::array<Vec3, 512> sums;
            row_sums(rows, begin, end, from, 3, sums[0].data());
            for (Index r = begin; r < end; ++r) out[rings.vertices[r]] = sums[r - begin];
        });
    for (const Index r : weights.fixed) out[rings.vertex(r)] = f[rings.vertex(r)];
}

Positions relaxed(const Rings& rings, const RingWeights& weights, const Positions& f) {
    Positions out = f;
    relax(rings, weights, f, out);
    return out;
}

}  // namespace multires
