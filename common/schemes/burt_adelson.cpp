#include "schemes/relaxed_rows.h"
#include "schemes/table.h"

// The pyramid after Burt and Adelson whose subdivision is a relaxation operator R. With f the values of a level:
//
//     analysis   c      = f + presmooth (R f - f)  on even vertices
//                d_odd  = f_odd  - R c
//                g      = c on even, on odd vertices f (Roy) or R c (Guskov)
//                d_even = f_even - R g
//     synthesis  the same lines solved for f, coarse to fine
//
// Roy et al. 2003 (eq. 4-7) predict even vertices from the reconstructed odd ones, details in world axes. Guskov et al.
// 1999 (section 3.2) predict them from the predicted odd ones, details in frames of the predicted surface, so that they
// turn with it. Cost of both ways: linear in the rows' entries times the width.

namespace multires {
namespace {

using namespace relaxed_rows;

class BurtAdelson final : public Scheme {
public:
    /// @param coarse  Guskov's way: evens are predicted from what the coarse level alone predicts
    BurtAdelson(const Hierarchy& h, const SchemeOptions& options, bool coarse)
        : Scheme(h), presmooth_(options.presmooth), coarse_(coarse), odd_(h.odd, h.positions, options) {
        for (const Rings& even : h.even) even_.emplace_back(even, h.positions, options);
    }

    Coefficients analyse(Field f, Storage storage) const override {
        return analyse_levels(hierarchy(), std::move(f), storage,
                              [&](std::size_t k, Field& values) { return analyse_level(k, values); });
    }

    Field synthesise(const Coefficients& coefficients, const Synthesis& how) const override {
        return synthesise(coefficients, how, nullptr);
    }

    void hand_over(const Coefficients& coefficients, const Take& take) const override {
        const Hierarchy& h = hierarchy();
        if (h.levels.empty() || h.even[0].rows() < h.size[1])  // one vertex a level: few change
            Scheme::hand_over(coefficients, take);
        else
            synthesise(coefficients, Synthesis(), &take);
    }

    std::size_t bytes() const override { return odd_.bytes() + relaxed_rows::bytes(even_); }

private:
    /// @param take  if not null: gets the input's level, which is not kept then
    Field synthesise(const Coefficients& coefficients, const Synthesis& how, const Take* take) const {
        const std::size_t last = take ? 1 : how.to;  // level that is kept
        Field scratch;                               // room for that one from the start: smaller ones leave holes
        return synthesise_levels(
            hierarchy(), coefficients, how, [&](std::size_t k, const std::vector<Subband>* d, double gain, Field& f) {
                with_details(d, gain, coarse_ && has_frames(f), [&](const auto& odd, const auto& even) {
                    if (k < last) {
                        scratch = Field();
                        return hand_over_finest(odd, even, f, *take);
                    }
                    scratch.width = f.width;
                    scratch.values.reserve(static_cast<std::size_t>(hierarchy().even[last].rows()) * f.width);
                    synthesise_level(k, odd, even, f, scratch);
                });
            });
    }

    /// The details of a level; f, its values, becomes g of the file's head. Touches only the rows that the level has:
    /// with one vertex per level there are few.
    std::vector<Subband> analyse_level(std::size_t k, Field& f) const {
        const Rings &odd_rings = hierarchy().odd, &even_rings = hierarchy().even[k];
        const bool frames = coarse_ && has_frames(f);
        std::vector<Subband> bands;
        bands.reserve(2);
        bands.push_back(values_at(odd_rings, hierarchy().levels[k].odd, f, frames));
        const RowRange all{0, even_rings.rows()};
        bands.push_back(presmooth_ > 0 ? with_values(even_rings, all, presmooth(k, f), frames)
                                       : values_at(even_rings, all, f, frames));
        Subband &odd = bands[0], &even = bands[1];
        const auto even_vertex = [&](Index r) { return even_rings.vertex(r); };
        predict_odd(hierarchy(), k, odd_, f, [&](Index r, const double* predicted) {
            subtract(odd, r, predicted, f);
            if (coarse_) copy_row(predicted, f.width, f.row(odd_rings.vertex(r)));
        });
        for_relaxed_rows(even_[k], 0, even_rings.rows(), f, even_vertex,
                         [&](Index r, const double* relaxed) { subtract(even, r, relaxed, f); });
        return bands;
    }

    /// Moves the even vertices; gives where they were.
    Field presmooth(std::size_t k, Field& f) const {
        const Rings& rings = hierarchy().even[k];
        const auto vertex = [&](Index r) { return rings.vertex(r); };
        Field smooth = Field::unset(rings.rows(), f.width);
        for_relaxed_rows(even_[k], 0, rings.rows(), f, vertex, [&](Index r, const double* relaxed) {
            const double* const c = f.row(vertex(r));
            for (int i = 0; i < f.width; ++i) smooth.row(r)[i] = c[i] + presmooth_ * (relaxed[i] - c[i]);
        });
        parallel_for(rings.rows(),
                     [&](Index r) { std::swap_ranges(smooth.row(r), smooth.row(r) + f.width, f.row(vertex(r))); });
        return smooth;
    }

    /// What f holds on even vertices, R of it on odd ones (Guskov), or these finished (Roy).
    template <class Value>
    void fill_odd(std::size_t k, const Details<Value>& odd, Field& f) const {
        predict_odd(hierarchy(), k, odd_, f, [&](Index r, const double* predicted) {
            double* const row = f.row(hierarchy().odd.vertex(r));
            if (coarse_)
                copy_row(predicted, f.width, row);
            else
                odd.add(r, predicted, f, row);
        });
    }

    /// synthesise_level() of the finest level, to be used at once; f stays what all is predicted from.
    template <class Value>
    void hand_over_finest(const Details<Value>& odd, const Details<Value>& even, Field& f, const Take& take) const {
        const Rings &odd_rings = hierarchy().odd, &even_rings = hierarchy().even[0];
        const auto vertex = [&](Index r) { return even_rings.vertex(r); };
        fill_odd(0, odd, f);
        for_relaxed_rows(even_[0], 0, even_rings.rows(), f, vertex, [&](Index r, double* value) {
            even.add(r, value, f, value);
            take(vertex(r), value);
        });
        const RowRange rows = hierarchy().levels[0].odd;
        parallel_chunks(rows.size(), 1024, [&](Index begin, Index end) {
            Field value = Field::unset(1, f.width);
            for (Index r = rows.begin + begin; r < rows.begin + end; ++r) {
                const Index place = odd_rings.vertex(r);
                if (coarse_) odd.add(r, f.row(place), f, value.row(0));
                take(place, coarse_ ? value.row(0) : f.row(place));
            }
        });
    }

    /// The inverse of analyse_level.
    /// @param values  to work in
    template <class Value>
    void synthesise_level(std::size_t k, const Details<Value>& odd, const Details<Value>& even, Field& f,
                          Field& values) const {
        const Level& level = hierarchy().levels[k];
        const Rings &odd_rings = hierarchy().odd, &even_rings = hierarchy().even[k];
        const int width = f.width;
        const auto odd_row = [&](Index r) { return f.row(odd_rings.vertex(r)); };
        // Guskov predicts even vertices from predicted odd ones: those are finished when that is done.
        fill_odd(k, odd, f);
        values.values.resize(static_cast<std::size_t>(even_rings.rows()) * width);  // rows need the old ones of all
        const auto vertex = [&](Index r) { return even_rings.vertex(r); };
        for_relaxed_rows(even_[k], 0, even_rings.rows(), f, vertex,
                         [&](Index r, const double* relaxed) { even.add(r, relaxed, f, values.row(r)); });
        if (coarse_)  // the sets in reverse order, so that frames are those of predicted vertices
            for (std::size_t s = level.sets(); s-- > 0;)
                parallel_for(level.set(s).size(), [&](Index i) {
                    const Index r = level.set(s).begin + i;
                    odd.add(r, odd_row(r), f, odd_row(r));
                });
        parallel_for(even_rings.rows(), [&](Index r) { copy_row(values.row(r), width, f.row(vertex(r))); });
    }

    double presmooth_;
    bool coarse_;
    Stencil odd_;
    std::vector<Stencil> even_;  ///< #levels
};

template <bool coarse>
std::unique_ptr<Scheme> make(const Hierarchy& hierarchy, const SchemeOptions& options) {
    return std::make_unique<BurtAdelson>(hierarchy, options, coarse);
}

}  // namespace

SchemeRow roy_scheme() {
    return {"Roy", "details in world axes",
            "<i>Roy, Foufou, Koschan, Truchetet, Abidi</i>, <b>\"Multiresolution Analysis for Irregular Meshes\"</b>, "
            "SPIE Photonics Technologies 2003",
            Capabilities(), make<false>};
}

SchemeRow guskov_scheme() {
    Capabilities can;
    can.local_frames = true;
    can.linear_precision = false;  // of evens beside odds of the boundary, which are predicted along it
    return {"Guskov",
            "details turn with the coarser surface, so that fine structure follows when coarse structure is "
            "changed",
            "<i>Guskov, Sweldens, Schr&ouml;der</i>, <b>\"Multiresolution Signal Processing for Meshes\"</b>, "
            "SIGGRAPH 1999",
            can, make<true>};
}

}  // namespace multires
