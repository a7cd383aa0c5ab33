#include "schemes/burt_adelson.h"

#include "base/parallel.h"
#include "schemes/frame.h"

#include <algorithm>

namespace multires {
namespace {

/// The weights of some rings, as they are stored.
struct Stencil {
    const Rings* rings = nullptr;
    RingWeights weights;
    Array<float> ring_single, flap_single;  ///< Storage::single: the weights, instead of those of `weights`

    Stencil(const Rings& r, const Positions& positions, const RelaxationTransformOptions& options)
        : rings(&r), weights(ring_weights(r, positions, options.relaxation)) {
        if (options.weights != Storage::single) return;
        narrow(weights.weight, ring_single);
        narrow(weights.flap_weight, flap_single);
    }

    RowWeights rows() const {
        if (ring_single.empty()) return row_weights(*rings, weights);
        return {rings, nullptr, nullptr, ring_single.data(), flap_single.empty() ? nullptr : flap_single.data()};
    }

    const std::vector<Index>& kept() const { return weights.kept; }

    static void narrow(Array<double>& wide, Array<float>& single) {
        single.assign(wide.begin(), wide.end());
        wide = Array<double>();
    }
};

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
    const std::vector<Index>& kept = s.kept();
    parallel_chunks(end - begin, 256, [&](Index from, Index to) {
        Field relaxed = Field::unset(to - from, f.width);
        from += begin, to += begin;
        row_sums(rows, from, to, f.values.data(), f.width, relaxed.row(0));
        for (auto k = std::lower_bound(kept.begin(), kept.end(), from); k != kept.end() && *k < to; ++k)
            std::copy_n(f.row(keep(*k)), f.width, relaxed.row(*k - from));
        for (Index r = from; r < to; ++r) take(r, relaxed.row(r - from));
    });
}

class RelaxationTransform final : public Transform {
public:
    RelaxationTransform(const Hierarchy& h, const RelaxationTransformOptions& options) : h_(h), options_(options) {
        for (const Level& level : h.levels) {
            odd_.emplace_back(level.odd, h.positions, options);
            even_.emplace_back(level.even, h.positions, options);
        }
    }

    Coefficients analyse(Field f, Storage storage) const override {
        Coefficients out;
        for (std::size_t k = 0; k < h_.levels.size(); ++k) {
            out.detail.emplace_back();
            analyse_level(k, f, out.detail.back());
            if (storage == Storage::single) narrow(out.detail.back());
        }
        f.values.shrink_to_fit();
        out.base = std::move(f);
        return out;
    }

    Field synthesise(const Coefficients& coefficients, const std::vector<double>& gain,
                     std::size_t to_level) const override {
        Field f = coefficients.base;
        f.values.reserve(static_cast<std::size_t>(h_.size[to_level]) * f.width);
        for (std::size_t k = h_.levels.size(); k-- > to_level;) {
            const Coefficients::Detail& d = coefficients.detail[k];
            const double g = gain.empty() ? 1 : gain[k];
            if (d.odd_single.empty())
                synthesise_level<double>(k, {d.odd.values.data(), d.even.values.data(), &d}, g, f);
            else
                synthesise_level<float>(k, {d.odd_single.data(), d.even_single.data(), &d}, g, f);
        }
        return f;
    }

    Field subdivide(const Field& values, std::size_t level) const override {
        Field f = values;
        f.values.reserve(static_cast<std::size_t>(h_.size[0]) * f.width);
        for (std::size_t k = level; k-- > 0;) synthesise_level<double>(k, {nullptr, nullptr, nullptr}, 0, f);
        return f;
    }

private:
    bool framed(const Field& f) const {
        return options_.scheme == Scheme::guskov && options_.local_frames && f.has_positions && f.width >= 3;
    }

    static void narrow(Coefficients::Detail& d) {
        d.odd_single.assign(d.odd.values.begin(), d.odd.values.end());
        d.even_single.assign(d.even.values.begin(), d.even.values.end());
        d.odd.values = d.even.values = Array<double>();
    }

    using Detail = Coefficients::Detail;

    /// The details of a level, as they are stored; null: zero.
    template <class Value>
    struct Stored {
        const Value* odd;
        const Value* even;
        const Detail* framed;
    };

    /// From values of the fine level to those of the coarse one, in place; stores the details. Touches only the rows
    /// that the level has: with one vertex per level there are few.
    void analyse_level(std::size_t k, Field& f, Coefficients::Detail& d) const {
        const Level& level = h_.levels[k];
        const int width = f.width;
        const auto even_vertex = [&](Index r) { return level.even.vertex(r); };
        // The details start as the values themselves, while f becomes g of the header.
        d.odd = Field::unset(level.odd.rows(), width);
        d.even = Field::unset(level.even.rows(), width);
        parallel_for(d.odd.rows(), [&](Index r) { copy_row(f.row(level.coarse + r), width, d.odd.row(r)); });
        parallel_for(d.even.rows(), [&](Index r) { copy_row(f.row(even_vertex(r)), width, d.even.row(r)); });
        if (options_.presmooth > 0) {
            Field smooth = Field::unset(level.even.rows(), width);
            for_relaxed_rows(even_[k], 0, level.even.rows(), f, even_vertex, [&](Index r, const double* relaxed) {
                const double* const c = f.row(even_vertex(r));
                for (int i = 0; i < width; ++i) smooth.row(r)[i] = c[i] + options_.presmooth * (relaxed[i] - c[i]);
            });
            parallel_for(level.even.rows(), [&](Index r) { copy_row(smooth.row(r), width, f.row(even_vertex(r))); });
        }
        const bool frames = framed(f);
        if (frames) d.odd_framed.resize(level.odd.rows()), d.even_framed.resize(level.even.rows());
        predict_odd(k, f, [&](Index r, const double* predicted) {
            Frame frame;
            if (frames) frame = frame_of(level.odd, r, f);
            store(d.odd.row(r), predicted, frames ? &frame : nullptr, width, d.odd_framed, r);
            if (options_.scheme == Scheme::guskov) copy_row(predicted, width, f.row(level.coarse + r));
        });
        for_relaxed_rows(even_[k], 0, level.even.rows(), f, even_vertex, [&](Index r, const double* relaxed) {
            Frame frame;
            if (frames) frame = frame_of(level.even, r, f);
            store(d.even.row(r), relaxed, frames ? &frame : nullptr, width, d.even_framed, r);
        });
        f.values.resize(static_cast<std::size_t>(level.coarse) * width);
        if (f.values.capacity() > 3 * f.values.size() / 2) f.values.shrink_to_fit();
    }

    /// The inverse of analyse_level with the details multiplied by `gain`.
    template <class Value>
    void synthesise_level(std::size_t k, const Stored<Value>& d, double gain, Field& f) const {
        const Level& level = h_.levels[k];
        const int width = f.width;
        const bool guskov = options_.scheme == Scheme::guskov;
        f.values.resize(static_cast<std::size_t>(level.fine) * width);
        const bool frames = framed(f) && d.framed;
        const auto finish = [&](const Rings& rings, Index r, const Value* details,
                                const std::vector<std::uint8_t> Detail::*flags, const double* predicted,
                                double* value) {
            Frame frame;
            const bool turned = frames && is_framed(d.framed->*flags, r);
            if (turned) frame = frame_of(rings, r, f);
            restore(row(details, r, width), predicted, turned ? &frame : nullptr, width, gain, value);
        };
        const auto finish_odd = [&](Index r, const double* predicted) {
            finish(level.odd, r, d.odd, &Detail::odd_framed, predicted, f.row(level.coarse + r));
        };
        // Guskov predicts even vertices from predicted odd ones: those are finished when that is done.
        if (guskov)
            predict_odd(k, f,
                        [&](Index r, const double* predicted) { copy_row(predicted, width, f.row(level.coarse + r)); });
        else
            predict_odd(k, f, finish_odd);
        Field even = Field::unset(level.even.rows(), width);  // rows need the old values of all
        const auto vertex = [&](Index r) { return level.even.vertex(r); };
        for_relaxed_rows(even_[k], 0, level.even.rows(), f, vertex, [&](Index r, const double* relaxed) {
            finish(level.even, r, d.even, &Detail::even_framed, relaxed, even.row(r));
        });
        if (guskov)  // the sets in reverse order, so that frames are those of predicted vertices
            for (std::size_t s = level.sets.size() - 1; s-- > 0;)
                parallel_for(level.sets[s + 1] - level.sets[s], [&](Index i) {
                    const Index r = level.sets[s] + i;
                    finish_odd(r, f.row(level.coarse + r));
                });
        parallel_for(level.even.rows(), [&](Index r) { copy_row(even.row(r), width, f.row(vertex(r))); });
    }

    /// Predicts every odd vertex from g and hands (row, prediction) to `take`, which may write g at that vertex. One
    /// set of odd vertices after the other.
    template <class Take>
    void predict_odd(std::size_t k, const Field& g, const Take& take) const {
        const Level& level = h_.levels[k];
        const auto parent = [&](Index r) { return h_.parent[level.coarse + r]; };
        for (std::size_t s = 0; s + 1 < level.sets.size(); ++s)
            for_relaxed_rows(odd_[k], level.sets[s], level.sets[s + 1], g, parent, take);
    }

    static Frame frame_of(const Rings& rings, Index r, const Field& g) {
        return ring_frame(rings.begin(r), rings.size(r), [&](Index v) {
            const double* p = g.row(v);
            return Vec3(p[0], p[1], p[2]);
        });
    }

    static bool is_framed(const std::vector<std::uint8_t>& framed, Index r) { return !framed.empty() && framed[r]; }

    /// A detail longer than its ring is wide stays in world axes: what rounding turns the frame by would move the
    /// vertex by more than it moved the ring, and grow from level to level.
    static void store(double* detail, const double* predicted, const Frame* frame, int width,
                      std::vector<std::uint8_t>& framed, Index r) {
        for (int c = 0; c < width; ++c) detail[c] -= predicted[c];
        if (!frame) return;
        const Vec3 world(detail[0], detail[1], detail[2]);
        framed[r] = world.squaredNorm() <= detail_limit * detail_limit * frame->size * frame->size;
        if (!framed[r]) return;
        const Vec3 local = frame->to_local(world);
        std::copy_n(local.data(), 3, detail);
    }

    template <class Value>
    static const Value* row(const Value* values, Index r, int width) {
        return values ? values + static_cast<std::size_t>(r) * width : nullptr;
    }

    template <class Value>
    static void restore(const Value* detail, const double* predicted, const Frame* frame, int width, double gain,
                        double* value) {
        if (!detail) {
            copy_row(predicted, width, value);
            return;
        }
        int c = 0;
        if (frame) {
            const Vec3 world = frame->to_world(Vec3(detail[0], detail[1], detail[2]));
            for (; c < 3; ++c) value[c] = predicted[c] + gain * world[c];
        }
        for (; c < width; ++c) value[c] = predicted[c] + gain * detail[c];
    }

    static constexpr double detail_limit = 0.5;  ///< in sizes of the frame

    const Hierarchy& h_;
    RelaxationTransformOptions options_;
    std::vector<Stencil> odd_, even_;
};

}  // namespace

std::unique_ptr<Transform> relaxation_transform(const Hierarchy& hierarchy, const RelaxationTransformOptions& options) {
    return std::make_unique<RelaxationTransform>(hierarchy, options);
}

}  // namespace multires
