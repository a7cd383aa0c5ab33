#pragma once

#include "base/parallel.h"
#include "schemes/frame.h"
#include "schemes/scheme.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

/// What schemes that predict vertices by a relaxation operator have in common: weights as they are stored, loops over
/// predicted rows, details into subbands and back.
namespace multires::relaxed_rows {

/// The weights of some rings, as they are stored.
class Stencil {
public:
    Stencil(const Rings& rings, const Positions& positions, const SchemeOptions& options)
        : Stencil(rings, ring_weights(rings, positions, relaxation(options.op)), options.storage) {}
    Stencil(const Rings& rings, RingWeights weights, Storage storage) : rings_(&rings), weights_(std::move(weights)) {
        if (storage != Storage::single) return;
        narrow(weights_.weight, ring_single_);
        narrow(weights_.flap_weight, flap_single_);
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
    static void narrow(Array<double>& wide, Array<float>& single) {
        single.assign(wide.begin(), wide.end());
        wide = Array<double>();
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
template <class Take>
void predict_odd(const Hierarchy& h, std::size_t k, const Stencil& odd, const Field& g, const Take& take) {
    const Level& level = h.levels[k];
    const auto parent = [&](Index r) { return h.parent[level.coarse + r]; };
    for (std::size_t s = 0; s + 1 < level.sets.size(); ++s)
        for_relaxed_rows(odd, level.sets[s], level.sets[s + 1], g, parent, take);
}

/// A subband whose rows are still the values themselves: those of `f` at its places.
inline Subband values_at(const Rings& rings, const Field& f, bool frames) {
    Subband band;
    band.rings = &rings;
    band.values = Field::unset(rings.rows(), f.width);
    if (frames) band.local.resize(rings.rows());
    parallel_for(rings.rows(), [&](Index r) { copy_row(f.row(rings.vertex(r)), f.width, band.values.row(r)); });
    return band;
}

/// Makes a row of values_at() a detail: what the prediction misses, in the frame of its ring over g if the subband has
/// frames.
inline void subtract(Subband& band, Index r, const double* predicted, const Field& g) {
    double* detail = band.values.row(r);
    for (int c = 0; c < band.values.width; ++c) detail[c] -= predicted[c];
    if (!band.local.empty()) band.local[r] = turn_into(frame_of(*band.rings, r, g), detail);
}

/// The details of a subband on their way back, as they are stored.
template <class Value>
struct Details {
    const Rings* rings = nullptr;
    const Value* values = nullptr;  ///< null: all are zero
    const std::uint8_t* local = nullptr;
    double gain = 1;

    /// The inverse of subtract(): prediction + gain x detail.
    void add(Index r, const double* predicted, const Field& g, double* value) const {
        const int width = g.width;
        if (!values) return copy_row(predicted, width, value);
        const Value* detail = values + static_cast<std::size_t>(r) * width;
        int c = 0;
        if (local && local[r]) {
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
    return {band.rings, values, frames && !band.local.empty() ? band.local.data() : nullptr, gain};
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
        if (f.values.capacity() > 3 * f.values.size() / 2) f.values.shrink_to_fit();
    }
    f.values.shrink_to_fit();
    out.base = std::move(f);
    return out;
}

}  // namespace multires::relaxed_rows
