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
        Field scratch;  // room for the largest level from the start: smaller ones leave holes
        return synthesise_levels(
            hierarchy(), coefficients, how, [&](std::size_t k, const std::vector<Subband>* d, double gain, Field& f) {
                scratch.width = f.width;
                scratch.values.reserve(static_cast<std::size_t>(hierarchy().even[how.to].rows()) * f.width);
                with_details(d, gain, coarse_ && has_frames(f),
                             [&](const auto& odd, const auto& even) { synthesise_level(k, odd, even, f, scratch); });
            });
    }

    std::size_t bytes() const override { return odd_.bytes() + relaxed_rows::bytes(even_); }

private:
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
        predict_odd(hierarchy(), k, odd_, f, [&](Index r, const double* predicted) {
            if (coarse_)
                copy_row(predicted, width, odd_row(r));
            else
                odd.add(r, predicted, f, odd_row(r));
        });
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
