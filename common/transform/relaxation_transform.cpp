#include "transform/relaxation_transform.h"

#include "parallel/parallel.h"
#include "transform/frame.h"

#include <algorithm>
#include <array>

namespace multires {
namespace {

/// Rows of weights over the columns of their rings or, for operators with flaps, over their own.
struct Stencil {
    const Rings* rings = nullptr;
    RingWeights ring;
    Rows rows;
    bool own = false;
    Array<float> single;  ///< Storage::single: the weights, instead of those of `ring` or `rows`

    const Array<Index>& offset() const { return own ? rows.offset : rings->offset; }
    const Array<Index>& column() const { return own ? rows.column : rings->neighbor; }
    const Array<double>& weight() const { return own ? rows.weight : ring.weight; }
    const std::vector<Index>& kept() const { return own ? rows.kept : ring.kept; }
};

Stencil make_stencil(const Rings& rings, const Positions& positions, const RelaxationTransformOptions& options) {
    Stencil s;
    s.rings = &rings;
    s.own = uses_flaps(options.relaxation.op);
    if (s.own)
        s.rows = relaxation(rings, positions, options.relaxation);
    else
        s.ring = ring_weights(rings, positions, options.relaxation);
    if (options.weights == Storage::single) {
        Array<double>& weight = s.own ? s.rows.weight : s.ring.weight;
        s.single.assign(weight.begin(), weight.end());
        weight = Array<double>();
    }
    return s;
}

/// Weighted sums of rows for a width known at compile time (0: at run time).
template <int Width>
struct Sums {
    const Stencil& s;
    const Index* offset = s.offset().data();
    const Index* column = s.column().data();
    const double* weight = s.weight().data();
    const float* single = s.single.data();

    void row(Index r, const Field& f, double* out) const {
        if (s.single.empty())
            add(r, f, out);
        else
            add_single(r, f, out);
    }

private:
    int width(const Field& f) const { return Width > 0 ? Width : f.width; }
    const double* at(const Field& f, Index k) const {
        return f.values.data() + static_cast<std::size_t>(column[k]) * width(f);
    }

    void add(Index r, const Field& f, double* out) const {
        const int w = width(f);
        std::array<double, std::max(Width, 1)> local{};
        double* const sum = Width > 0 ? local.data() : out;
        std::fill_n(sum, w, 0.0);
        for (Index k = offset[r]; k < offset[r + 1]; ++k) {
            const double* v = at(f, k);
            for (int c = 0; c < w; ++c) sum[c] += weight[k] * v[c];
        }
        if (Width > 0) std::copy_n(local.data(), w, out);
    }

    /// Rounded weights do not sum to 1; used as differences to the first value, they need not.
    void add_single(Index r, const Field& f, double* out) const {
        const int w = width(f);
        if (offset[r] == offset[r + 1]) {
            std::fill_n(out, w, 0.0);
            return;
        }
        const double* first = at(f, offset[r]);
        std::copy_n(first, w, out);
        for (Index k = offset[r] + 1; k < offset[r + 1]; ++k) {
            const double* v = at(f, k);
            for (int c = 0; c < w; ++c) out[c] += static_cast<double>(single[k]) * (v[c] - first[c]);
        }
    }
};

/// R f of all rows into `out`; rows that keep their value take it from row keep(r) of f.
template <int Width, class Keep>
void relax_rows(const Stencil& s, const Field& f, Field& out, const Keep& keep) {
    const Sums<Width> sums{s};
    const Index rows = s.rings->rows();
    parallel_for(rows, [&](Index r) { sums.row(r, f, out.row(r)); });
    for (const Index r : s.kept()) std::copy_n(f.row(keep(r)), f.width, out.row(r));
}

template <class Keep>
void relax_rows(const Stencil& s, const Field& f, Field& out, const Keep& keep) {
    switch (f.width) {
    case 1:
        return relax_rows<1>(s, f, out, keep);
    case 3:
        return relax_rows<3>(s, f, out, keep);
    case 4:
        return relax_rows<4>(s, f, out, keep);
    default:
        return relax_rows<0>(s, f, out, keep);
    }
}

class RelaxationTransform final : public Transform {
public:
    RelaxationTransform(const Hierarchy& h, const RelaxationTransformOptions& options) : h_(h), options_(options) {
        for (const Level& level : h.levels) {
            odd_.push_back(make_stencil(level.odd, h.positions, options));
            even_.push_back(make_stencil(level.even, h.positions, options));
        }
    }

    Coefficients analyse(const Field& input, Storage storage) const override {
        Coefficients out;
        Field f = input;
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
        for (std::size_t k = h_.levels.size(); k-- > to_level;)
            synthesise_stored(k, coefficients.detail[k], gain.empty() ? 1 : gain[k], f);
        return f;
    }

    Field subdivide(const Field& values, std::size_t level) const override {
        Field f = values;
        f.values.reserve(static_cast<std::size_t>(h_.size[0]) * f.width);
        for (std::size_t k = level; k-- > 0;) {
            const Coefficients::Detail zero{
                Field(h_.levels[k].odd.rows(), f.width), Field(h_.levels[k].even.rows(), f.width), {}, {}};
            synthesise_level(k, zero, 0, f);
        }
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

    void synthesise_stored(std::size_t k, const Coefficients::Detail& d, double gain, Field& f) const {
        if (d.odd_single.empty() && d.even_single.empty())
            synthesise_level(k, d, gain, f);
        else
            synthesise_level(k, widened(d, f.width), gain, f);
    }

    /// From values of the fine level to those of the coarse one, in place; stores the details. Touches only the rows
    /// that the level has: with one vertex per level there are few.
    void analyse_level(std::size_t k, Field& f, Coefficients::Detail& d) const {
        const Level& level = h_.levels[k];
        const int width = f.width;
        const auto even_vertex = [&](Index r) { return level.even.vertex(r); };
        // The details start as the values themselves, while f becomes g of the header.
        d.odd = Field::unset(level.odd.rows(), width);
        d.even = Field::unset(level.even.rows(), width);
        parallel_for(d.odd.rows(), [&](Index r) { std::copy_n(f.row(level.coarse + r), width, d.odd.row(r)); });
        parallel_for(d.even.rows(), [&](Index r) { std::copy_n(f.row(even_vertex(r)), width, d.even.row(r)); });
        Field relaxed = Field::unset(level.even.rows(), width);
        if (options_.presmooth > 0) {
            relax_rows(even_[k], f, relaxed, even_vertex);
            parallel_for(level.even.rows(), [&](Index r) {
                double* c = f.row(even_vertex(r));
                for (int i = 0; i < width; ++i) c[i] += options_.presmooth * (relaxed.row(r)[i] - c[i]);
            });
        }
        const bool frames = framed(f);
        if (frames) d.odd_framed.resize(level.odd.rows()), d.even_framed.resize(level.even.rows());
        predict_odd(k, f, [&](Index r, const double* predicted, const Frame* frame) {
            store(d.odd.row(r), predicted, frame, width, d.odd_framed, r);
            if (options_.scheme == Scheme::guskov) std::copy_n(predicted, width, f.row(level.coarse + r));
        });
        relax_rows(even_[k], f, relaxed, even_vertex);
        parallel_for(level.even.rows(), [&](Index r) {
            Frame frame;
            if (frames) frame = frame_of(level.even, r, f);
            store(d.even.row(r), relaxed.row(r), frames ? &frame : nullptr, width, d.even_framed, r);
        });
        f.values.resize(static_cast<std::size_t>(level.coarse) * width);
    }

    /// The inverse of analyse_level with the details multiplied by `gain`.
    void synthesise_level(std::size_t k, const Coefficients::Detail& d, double gain, Field& f) const {
        const Level& level = h_.levels[k];
        const int width = f.width;
        const bool guskov = options_.scheme == Scheme::guskov;
        f.values.resize(static_cast<std::size_t>(level.fine) * width);
        // Guskov predicts even vertices from predicted odd ones; the odd ones' own values wait until that is done.
        Field odd = Field::unset(guskov ? level.odd.rows() : 0, width);
        predict_odd(k, f, [&](Index r, const double* predicted, const Frame* frame) {
            double* at = f.row(level.coarse + r);
            double value[max_width];
            std::vector<double> large(width > max_width ? width : 0);
            double* to = width > max_width ? large.data() : value;
            restore(d.odd.row(r), predicted, frame && is_framed(d.odd_framed, r) ? frame : nullptr, width, gain, to);
            std::copy_n(guskov ? predicted : to, width, at);
            if (guskov) std::copy_n(to, width, odd.row(r));
        });
        Field relaxed = Field::unset(level.even.rows(), width);
        relax_rows(even_[k], f, relaxed, [&](Index r) { return level.even.vertex(r); });
        const bool frames = framed(f);
        if (frames) {  // in place: frames need the old values of all
            parallel_for(level.even.rows(), [&](Index r) {
                const Frame frame = frame_of(level.even, r, f);
                double* to = relaxed.row(r);
                restore(d.even.row(r), to, is_framed(d.even_framed, r) ? &frame : nullptr, width, gain, to);
            });
        }
        parallel_for(level.even.rows(), [&](Index r) {
            double* to = f.row(level.even.vertex(r));
            if (frames)
                std::copy_n(relaxed.row(r), width, to);
            else
                restore(d.even.row(r), relaxed.row(r), nullptr, width, gain, to);
        });
        if (guskov) std::copy(odd.values.begin(), odd.values.end(), f.row(level.coarse));
    }

    /// Predicts every odd vertex from g and hands (row, prediction, frame or null) to `take`, which may write g at that
    /// vertex. One set of odd vertices after the other.
    template <class Take>
    void predict_odd(std::size_t k, const Field& g, const Take& take) const {
        switch (g.width) {
        case 1:
            return predict_odd<1>(k, g, take);
        case 3:
            return predict_odd<3>(k, g, take);
        case 4:
            return predict_odd<4>(k, g, take);
        default:
            return predict_odd<0>(k, g, take);
        }
    }

    template <int Width, class Take>
    void predict_odd(std::size_t k, const Field& g, const Take& take) const {
        const Level& level = h_.levels[k];
        const Sums<Width> sums{odd_[k]};
        const bool frames = framed(g);
        const std::vector<Index>& kept = odd_[k].kept();
        const auto one = [&](Index r) {
            double value[max_width];
            std::vector<double> large(g.width > max_width ? g.width : 0);
            double* predicted = g.width > max_width ? large.data() : value;
            if (!kept.empty() && std::binary_search(kept.begin(), kept.end(), r))
                std::copy_n(g.row(h_.parent[level.coarse + r]), g.width, predicted);
            else
                sums.row(r, g, predicted);
            Frame frame;
            if (frames) frame = frame_of(level.odd, r, g);
            take(r, predicted, frames ? &frame : nullptr);
        };
        for (std::size_t s = 0; s + 1 < level.sets.size(); ++s) {
            const Index first = level.sets[s];
            parallel_for(level.sets[s + 1] - first, [&](Index r) { one(first + r); });
        }
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

    static void restore(const double* detail, const double* predicted, const Frame* frame, int width, double gain,
                        double* value) {
        int c = 0;
        if (frame) {
            const Vec3 world = frame->to_world(Vec3(detail[0], detail[1], detail[2]));
            for (; c < 3; ++c) value[c] = predicted[c] + gain * world[c];
        }
        for (; c < width; ++c) value[c] = predicted[c] + gain * detail[c];
    }

    static constexpr int max_width = 16;
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
