#include "operators/relaxation.h"

#include "operators/kernels.h"
#include "parallel/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

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
    std::vector<std::vector<Index>> kept((rows + chunk - 1) / chunk);
    parallel_chunks(rows, chunk, [&](Index begin, Index end) {
        RowRelaxation relaxation(options);
        for (Index r = begin; r < end; ++r) {
            if (!row(relaxation, r)) kept[begin / chunk].push_back(r);
        }
    });
    std::vector<Index> all;
    for (const std::vector<Index>& part : kept) all.insert(all.end(), part.begin(), part.end());
    return all;
}

/// Sum of a row. Rows of up to 8 entries, nearly all, take 8 steps without a branch: what lies beyond the end of the
/// row counts 0. A loop over 5, 6 or 7 entries is mispredicted at nearly every row, which costs more than the sums.
Vec3 row_sum(const Index* column, const double* weight, Index size, Index readable, const Positions& f) {
    constexpr Index few = 8;
    static constexpr std::array<double, 2 * few> counts = {1, 1, 1, 1, 1, 1, 1, 1};
    Vec3 sum = Vec3::Zero();
    if (size <= few && readable >= few) {
        const double* const count = counts.data() + few - size;
        for (Index k = 0; k < few; ++k) sum += (count[k] * weight[k]) * f[column[k]];
    } else {
        for (Index k = 0; k < size; ++k) sum += weight[k] * f[column[k]];
    }
    return sum;
}

void relax(const Rings& rings, const Array<Index>& offset, const Array<Index>& column, const Array<double>& weight,
           const std::vector<Index>& kept, const Positions& f, Positions& out) {
    const Index entries = static_cast<Index>(weight.size());
    parallel_for(rings.rows(), [&](Index r) {
        const Index at = offset[r];
        out[rings.vertex(r)] = row_sum(column.data() + at, weight.data() + at, offset[r + 1] - at, entries - at, f);
    });
    for (const Index r : kept) out[rings.vertex(r)] = f[rings.vertex(r)];
}

}  // namespace

RowRelaxation::RowRelaxation(const RelaxationOptions& options)
    : options_(options), largest_cotangent_(1 / std::tan(options.smallest_angle * std::acos(-1.0) / 180)) {}

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

bool RowRelaxation::ring(const Star& star, const Positions& positions, double* weight) {
    const Curve curve = rule(star);
    if (curve.rule != Rule::disk) {
        std::fill_n(weight, star.size, 0.0);
        if (curve.rule == Rule::curve) interpolate(star, positions, curve.a, curve.b, weight);
        return curve.rule == Rule::curve;
    }
    if (options_.op == Operator::umbrella) {
        std::fill_n(weight, star.size, 1.0 / star.size);
        return true;
    }
    geometry_.load(star, positions, options_.degenerate);
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
        found = kernels::second_difference(geometry_, star.feature, nullptr, star.size, weight);
        break;
    case Operator::umbrella:
    case Operator::second_difference_flaps:
        throw std::invalid_argument("RowRelaxation::ring: operator uses flaps");
    }
    return accept(found, star, star.size, weight);
}

bool RowRelaxation::accept(bool found, const Star& star, Index columns, double* weight) {
    if (found) {
        double norm = 0;
        for (Index k = 0; k < columns; ++k) norm += std::abs(weight[k]);
        if (norm <= options_.largest_norm) return true;
    }
    std::fill_n(weight, columns, 0.0);
    if (has_feature(star)) return false;
    if (!kernels::cotangent_delaunay(geometry_, weight)) inverse_lengths(geometry_, weight);
    return true;
}

Index RowRelaxation::flap_columns(const Star& star) {
    if (star.kind != RingKind::closed) return star.size;
    const auto counts = [&](Index f) { return f >= 0 && f != star.vertex; };
    return star.size + static_cast<Index>(std::count_if(star.flap, star.flap + star.size, counts));
}

void RowRelaxation::flap_slots(const Star& star) {
    if (star.size > static_cast<Index>(slot_.size())) {
        slot_.resize(2 * star.size);
        extra_.resize(2 * star.size);
    }
    extra_count_ = 0;
    if (star.kind != RingKind::closed) return;
    star.size > 64 ? hash_flaps(star) : search_flaps(star);
}

void RowRelaxation::search_flaps(const Star& star) {
    const Index n = star.size;
    const Index* const ring_end = star.neighbor + n;
    Index* const extra = extra_.data();
    Index count = 0;
    // Most flaps are new: one bit per vertex number modulo 64 tells nearly all of them without a search.
    const auto bit = [](Index v) { return std::uint64_t{1} << (v & 63); };
    std::uint64_t seen = 0;
    for (Index j = 0; j < n; ++j) seen |= bit(star.neighbor[j]);
    for (Index j = 0; j < n; ++j) {
        const Index f = star.flap[j];
        slot_[j] = -1;
        if (f < 0 || f == star.vertex) continue;
        if ((seen & bit(f)) != 0) {
            const Index* const in_ring = std::find(star.neighbor, ring_end, f);
            const Index* const known = std::find(extra, extra + count, f);
            if (in_ring != ring_end) slot_[j] = static_cast<Index>(in_ring - star.neighbor);
            if (known != extra + count) slot_[j] = n + static_cast<Index>(known - extra);
            if (slot_[j] >= 0) continue;
        }
        seen |= bit(f);
        slot_[j] = n + count;
        extra[count++] = f;
    }
    extra_count_ = count;
}

void RowRelaxation::hash_flaps(const Star& star) {
    std::unordered_map<Index, Index> slots;
    for (Index j = 0; j < star.size; ++j) slots.emplace(star.neighbor[j], j);
    for (Index j = 0; j < star.size; ++j) {
        const Index f = star.flap[j];
        slot_[j] = -1;
        if (f < 0 || f == star.vertex) continue;
        const auto [at, is_new] = slots.emplace(f, star.size + extra_count_);
        slot_[j] = at->second;
        if (is_new) extra_[extra_count_++] = f;
    }
}

bool RowRelaxation::flaps(const Star& star, const Positions& positions, Index* column, double* weight) {
    flap_slots(star);
    const Index columns = flap_columns(star), own = star.size + extra_count_;
    std::copy_n(star.neighbor, star.size, column);
    std::copy_n(extra_.data(), extra_count_, column + star.size);
    if (own < columns) std::fill(column + own, column + columns, column[0]);  // flaps that had a column already
    const Curve curve = rule(star);
    if (curve.rule != Rule::disk) {
        std::fill_n(weight, columns, 0.0);
        if (curve.rule == Rule::curve) interpolate(star, positions, curve.a, curve.b, weight);
        return curve.rule == Rule::curve;
    }
    geometry_.load(star, positions, options_.degenerate);
    const kernels::Flaps flaps{star.flap, slot_.data(), &positions, positions[star.vertex], options_.degenerate};
    return accept(kernels::second_difference(geometry_, star.feature, &flaps, columns, weight), star, columns, weight);
}

RingWeights ring_weights(const Rings& rings, const Positions& positions, const RelaxationOptions& options) {
    if (uses_flaps(options.op)) throw std::invalid_argument("ring_weights: the operator uses flaps");
    RingWeights result;
    result.weight.resize(rings.neighbor.size());
    result.kept = for_rows(rings.rows(), options, [&](RowRelaxation& relaxation, Index r) {
        return relaxation.ring(star(rings, r), positions, result.weight.data() + rings.offset[r]);
    });
    return result;
}

Rows relaxation(const Rings& rings, const Positions& positions, const RelaxationOptions& options) {
    Rows rows;
    if (!uses_flaps(options.op)) {
        RingWeights weights = ring_weights(rings, positions, options);
        rows.offset = rings.offset;
        rows.column = rings.neighbor;
        rows.weight = std::move(weights.weight);
        rows.kept = std::move(weights.kept);
        return rows;
    }
    if (rings.flap.size() != rings.neighbor.size()) throw std::invalid_argument("relaxation: the rings have no flaps");
    rows.offset.resize(rings.rows() + 1);
    for_rows(rings.rows(), options, [&](RowRelaxation& relaxation, Index r) {
        rows.offset[r + 1] = relaxation.flap_columns(star(rings, r));
        return true;
    });
    for (Index r = 0; r < rings.rows(); ++r) rows.offset[r + 1] += rows.offset[r];
    rows.column.resize(rows.offset.back());
    rows.weight.resize(rows.offset.back());
    rows.kept = for_rows(rings.rows(), options, [&](RowRelaxation& relaxation, Index r) {
        const Index at = rows.offset[r];
        return relaxation.flaps(star(rings, r), positions, rows.column.data() + at, rows.weight.data() + at);
    });
    return rows;
}

void relax(const Rings& rings, const RingWeights& weights, const Positions& f, Positions& out) {
    relax(rings, rings.offset, rings.neighbor, weights.weight, weights.kept, f, out);
}

void relax(const Rings& rings, const Rows& rows, const Positions& f, Positions& out) {
    relax(rings, rows.offset, rows.column, rows.weight, rows.kept, f, out);
}

Positions relaxed(const Rings& rings, const RingWeights& weights, const Positions& f) {
    Positions out = f;
    relax(rings, weights, f, out);
    return out;
}

Positions relaxed(const Rings& rings, const Rows& rows, const Positions& f) {
    Positions out = f;
    relax(rings, rows, f, out);
    return out;
}

}  // namespace multires
