#pragma once

#include "base/parallel.h"
#include "schemes/frame.h"
#include "schemes/scheme.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

/// What schemes that predict vertices by a relaxation operator have in common: weights as they are stored, loops over
/// predicted rows, details into subbands and back.
namespace multires::relaxed_rows {

/// The weights of some rings, as they are stored.
class Stencil {
public:
    Stencil(const Rings& rings, const Positions& positions, const SchemeOptions& options) : rings_(&rings) {
        if (options.storage == Storage::single)
            make_single(positions, relaxation(options.op));
        else
            weights_ = ring_weights(rings, positions, relaxation(options.op));
    }

    RowWeights rows() const {
        if (ring_single_.empty()) return row_weights(*rings_, weights_);
        return {rings_, nullptr, nullptr, ring_single_.data(), flap_single_.empty() ? nullptr : flap_single_.data()};
    }

    /// Rows whose vertex keeps its value, ascending.
    const std::vector<Index>& fixed() const { return weights_.fixed; }

    std::size_t bytes() const {
        return (weights_.weight.capacity() + weights_.flap_weight.capacity()) * sizeof(double) +
               (ring_single_.capacity() + flap_single_.capacity()) * sizeof(float) +
               weights_.fixed.capacity() * sizeof(Index);
    }

private:
    static RelaxationOptions relaxation(Operator op) {
        RelaxationOptions options;
        options.op = op;
        return options;
    }

    /// The same weights, never all of them as double.
    void make_single(const Positions& positions, const RelaxationOptions& options) {
        const Rings& rings = *rings_;
        const bool flaps = uses_flaps(options.op);
        if (flaps && rings.flap.size() != rings.neighbor.size())
            throw std::invalid_argument("Stencil: the rings have no flaps");
        ring_single_.resize(rings.neighbor.size());
        if (flaps) flap_single_.resize(rings.neighbor.size());
        std::vector<std::uint8_t> fixed(rings.rows());
        parallel_chunks(rings.rows(), 512, [&](Index begin, Index end) {
            RowRelaxation relaxation(options);
            std::vector<double> ring, flap;
            for (Index r = begin; r < end; ++r) {
                const Index size = rings.size(r), at = rings.offset[r];
                ring.resize(size);
                flap.resize(size);
                fixed[r] = !relaxation.row(star(rings, r), positions, ring.data(), flaps ? flap.data() : nullptr);
                std::copy_n(ring.begin(), size, ring_single_.begin() + at);
                if (flaps) std::copy_n(flap.begin(), size, flap_single_.begin() + at);
            }
        });
        for (Index r = 0; r < rings.rows(); ++r)
            if (fixed[r]) weights_.fixed.push_back(r);
    }

    const Rings* rings_;
    RingWeights weights_;
    Array<float> ring_single_, flap_single_;  ///< Storage::single: the weights, instead of those of `weights_`
};

inline std::size_t bytes(const std::vector<Stencil>& stencils) {
    std::size_t sum = stencils.capacity() * sizeof(Stencil);
    for (const Stencil& s : stencils) sum += s.bytes();
    return sum;
}

/// Copies one row. Three channels, the common case, without a call.
inline void copy_row(const double* from, int width, double* to) {
    if (width == 3)
        to[0] = from[0], to[1] = from[1], to[2] = from[2];
    else
        std::copy_n(from, width, to);
}

/// Calls take(row, R f) for the rows begin..end-1, in parallel; those that keep their value take it from row keep(r) of
/// f. What take() reads of a row's neighbours is still near.
template <class Keep, class Take>
void for_relaxed_rows(const Stencil& s, Index begin, Index end, const Field& f, const Keep& keep, const Take& take) {
    const RowWeights rows = s.rows();
    const std::vector<Index>& fixed = s.fixed();
    parallel_chunks(end - begin, 256, [&](Index from, Index to) {
        Field relaxed = Field::unset(to - from, f.width);
        from += begin, to += begin;
        row_sums(rows, from, to, f.values.data(), f.width, relaxed.row(0));
        for (auto k = std::lower_bound(fixed.begin(), fixed.end(), from); k != fixed.end() && *k < to; ++k)
            std::copy_n(f.row(keep(*k)), f.width, relaxed.row(*k - from));
        for (Index r = from; r < to; ++r) take(r, relaxed.row(r - from));
    });
}

/// Predicts every odd vertex of a level from g and hands (row, prediction) to `take`, which may write g at that vertex.
/// One set of odd vertices after the other. An odd vertex that keeps its value is predicted by its parent.
/// @param odd  of Hierarchy::odd, as the rows are
template <class Take>
void predict_odd(const Hierarchy& h, std::size_t k, const Stencil& odd, const Field& g, const Take& take) {
    const Level& level = h.levels[k];
    const auto parent = [&](Index r) { return h.parent[h.odd.vertex(r)]; };
    for (std::size_t s = 0; s < level.sets(); ++s)
        for_relaxed_rows(odd, level.set(s).begin, level.set(s).end, g, parent, take);
}

/// A subband whose rows are still the values themselves.
inline Subband with_values(const Rings& rings, RowRange range, Field values, bool frames) {
    Subband band;
    band.rings = &rings;
    band.range = range;
    band.values = std::move(values);
    if (frames) band.local.resize(band.rows());
    return band;
}

/// Those of `f` at its places.
inline Subband values_at(const Rings& rings, RowRange range, const Field& f, bool frames) {
    Subband band = with_values(rings, range, Field::unset(range.size(), f.width), frames);
    parallel_for(band.rows(), [&](Index r) { copy_row(f.row(band.place(r)), f.width, band.values.row(r)); });
    return band;
}

/// Makes a row of values_at() a detail: what the prediction misses, in the frame of its ring over g if the subband has
/// frames.
/// @param r  row of the rings
inline void subtract(Subband& band, Index r, const double* predicted, const Field& g) {
    const Index own = r - band.range.begin;
    double* detail = band.values.row(own);
    for (int c = 0; c < band.values.width; ++c) detail[c] -= predicted[c];
    if (!band.local.empty()) band.local[own] = turn_into(frame_of(*band.rings, r, g), detail);
}

/// The details of a subband on their way back, as they are stored.
template <class Value>
struct Details {
    const Rings* rings = nullptr;
    const Value* values = nullptr;  ///< null: all are zero
    const std::uint8_t* local = nullptr;
    double gain = 1;
    Index first = 0;  ///< row of the rings that the first detail belongs to

    /// The inverse of subtract(): prediction + gain x detail.
    /// @param r  row of the rings
    void add(Index r, const double* predicted, const Field& g, double* value) const {
        const int width = g.width;
        if (!values) return copy_row(predicted, width, value);
        const Value* detail = values + static_cast<std::size_t>(r - first) * width;
        int c = 0;
        if (local && local[r - first]) {
            const Vec3 world = frame_of(*rings, r, g).to_world(Vec3(detail[0], detail[1], detail[2]));
            for (; c < 3; ++c) value[c] = predicted[c] + gain * world[c];
        }
        for (; c < width; ++c) value[c] = predicted[c] + gain * detail[c];
    }
};

/// True if details of this field are kept in frames of a scheme that has them.
inline bool has_frames(const Field& f) { return f.has_positions && f.width >= 3; }

template <class Value>
Details<Value> details_of(const Subband& band, double gain, bool frames) {
    const Value* values = nullptr;
    if constexpr (std::is_same_v<Value, float>)
        values = band.single.data();
    else
        values = band.values.values.data();
    return {band.rings, values, frames && !band.local.empty() ? band.local.data() : nullptr, gain, band.range.begin};
}

/// Calls run(first, last) with the details of the first and the last subband of a level as they are stored, both
/// Details<double> or both Details<float>.
/// @param bands  null: all details are zero
template <class Run>
void with_details(const std::vector<Subband>* bands, double gain, bool frames, const Run& run) {
    if (!bands) return run(Details<double>(), Details<double>());
    const Subband &first = bands->front(), &last = bands->back();
    if (first.single.empty())
        run(details_of<double>(first, gain, frames), details_of<double>(last, gain, frames));
    else
        run(details_of<float>(first, gain, frames), details_of<float>(last, gain, frames));
}

/// Synthesis of all levels, one by one: values of a level become those of the finer one, in place.
/// @param level  void(std::size_t k, const std::vector<Subband>* details, double gain, Field& f); null: all are zero
template <class Level>
Field synthesise_levels(const Hierarchy& h, const Coefficients& coefficients, const Synthesis& how,
                        const Level& level) {
    Field f = how.values ? *how.values : coefficients.base;
    f.values.reserve(static_cast<std::size_t>(h.size[how.to]) * f.width);
    for (std::size_t k = how.values ? how.from : h.levels.size(); k-- > how.to;) {
        f.values.resize(static_cast<std::size_t>(h.levels[k].fine) * f.width);
        level(k, coefficients.level.empty() ? nullptr : &coefficients.level[k], how.gain.empty() ? 1 : how.gain[k], f);
    }
    return f;
}

/// Analysis of all levels, one by one: values of a level become those of the coarser one, in place.
/// @param level  std::vector<Subband>(std::size_t k, Field& f)
template <class Level>
Coefficients analyse_levels(const Hierarchy& h, Field f, Storage storage, const Level& level) {
    Coefficients out;
    for (std::size_t k = 0; k < h.levels.size(); ++k) {
        out.level.push_back(level(k, f));
        if (storage == Storage::single)
            for (Subband& band : out.level.back()) narrow(band);
        f.values.resize(static_cast<std::size_t>(h.levels[k].coarse) * f.width);
    }
    f.values.shrink_to_fit();
    out.base = std::move(f);
    return out;
}

}  // namespace multires::relaxed_rows
