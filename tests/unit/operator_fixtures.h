#pragma once

#include "fixtures.h"
#include "operators/relaxation.h"
#include "random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

/// What the tests of the relaxation operators share.
namespace multires::fixtures {

inline constexpr Operator all_operators[] = {
    Operator::umbrella,           Operator::cotangent,         Operator::cotangent_clamped,
    Operator::cotangent_delaunay, Operator::second_difference, Operator::second_difference_flaps,
    Operator::natural_neighbours, Operator::thin_plate,        Operator::thin_plate_flaps};
inline constexpr Operator linear_precise[] = {Operator::cotangent,          Operator::cotangent_delaunay,
                                              Operator::second_difference,  Operator::second_difference_flaps,
                                              Operator::natural_neighbours, Operator::thin_plate,
                                              Operator::thin_plate_flaps};

inline RelaxationOptions with(Operator op) {
    RelaxationOptions options;
    options.op = op;
    return options;
}

/// A closed star around vertex 0 whose ring is 1, 2, ..., n.
struct ClosedStar {
    explicit ClosedStar(Positions p) : positions(std::move(p)) {
        rings.offset = {0, static_cast<Index>(positions.size()) - 1};
        for (Index v = 1; v < static_cast<Index>(positions.size()); ++v) rings.neighbor.push_back(v);
        rings.kind = {RingKind::closed};
    }
    Array<double> weights(Operator op) const { return ring_weights(rings, positions, with(op)).weight; }

    Positions positions;
    Rings rings;
};

/// n points at random distances and increasing angles around the origin, all gaps below 180 degrees; the origin first.
inline Positions planar_star(Index n, std::uint64_t seed) {
    shapes::Random random(seed);
    Positions p{Vec3::Zero()};
    for (Index j = 0; j < n; ++j) {
        const double angle = 2 * std::acos(-1.0) * (j + random.uniform(0, 0.9)) / n, r = random.uniform(0.1, 2);
        p.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
    }
    return p;
}

inline bool is_fixed(const std::vector<Index>& fixed, Index row) {
    return std::binary_search(fixed.begin(), fixed.end(), row);
}

/// Rows as a sparse matrix has them: every column once, the ring first, then the flaps that are not in it.
struct Rows {
    std::vector<Index> offset{0}, column;
    std::vector<double> weight;
    std::vector<Index> fixed;
};

inline Rows sparse_rows(const Rings& rings, const Positions& positions, const RelaxationOptions& options) {
    const RingWeights weights = ring_weights(rings, positions, options);
    Rows rows;
    rows.fixed = weights.fixed;
    for (Index r = 0; r < rings.rows(); ++r) {
        for (Index k = rings.offset[r]; k < rings.offset[r + 1]; ++k) {
            rows.column.push_back(rings.neighbor[k]);
            rows.weight.push_back(weights.weight[k]);
        }
        for (Index k = rings.offset[r]; k < rings.offset[r + 1] && !weights.flap_weight.empty(); ++k) {
            if (!rings.has_flap(k)) {
                EXPECT_EQ(weights.flap_weight[k], 0);
                continue;
            }
            const auto at = std::find(rows.column.begin() + rows.offset[r], rows.column.end(), rings.flap[k]);
            if (at == rows.column.end()) {
                rows.column.push_back(rings.flap[k]);
                rows.weight.push_back(weights.flap_weight[k]);
            } else {
                rows.weight[at - rows.column.begin()] += weights.flap_weight[k];
            }
        }
        rows.offset.push_back(static_cast<Index>(rows.column.size()));
    }
    return rows;
}

inline double sum_of_row(const Rows& rows, Index r) {
    double sum = 0;
    for (Index k = rows.offset[r]; k < rows.offset[r + 1]; ++k) sum += rows.weight[k];
    return sum;
}

inline double largest_weight(const Rows& rows, Index r) {
    double largest = 1;
    for (Index k = rows.offset[r]; k < rows.offset[r + 1]; ++k) largest = std::max(largest, std::abs(rows.weight[k]));
    return largest;
}

}  // namespace multires::fixtures
