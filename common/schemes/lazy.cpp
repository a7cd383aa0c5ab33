#include "schemes/relaxed_rows.h"
#include "schemes/table.h"

// The critically sampled form of burt_adelson.cpp: even vertices stay as they are ("lazy", Sweldens 1998) and have no
// details; an odd one is predicted from the vertices that are there when it comes back, finished ones of its own level
// among them, and its detail turns with their frame:
//
//     analysis   d_odd = f_odd - R f,  set by set
//     synthesis  the same line solved for f_odd, the sets in their order
//
// As many coefficients as values and half the weights: the least memory and time. Nothing keeps fine waves from coming
// back as coarse ones in the coarse levels, which are subsets of the values.

namespace multires {
namespace {

using namespace relaxed_rows;

class Lazy final : public Scheme {
public:
    Lazy(const Hierarchy& h, const SchemeOptions& options) : Scheme(h), odd_(h.odd, h.positions, options) {}

    Coefficients analyse(Field f, Storage storage) const override {
        return analyse_levels(hierarchy(), std::move(f), storage, [&](std::size_t k, const Field& values) {
            std::vector<Subband> bands;
            bands.push_back(values_at(hierarchy().odd, hierarchy().levels[k].odd, values, has_frames(values)));
            predict_odd(hierarchy(), k, odd_, values,
                        [&](Index r, const double* predicted) { subtract(bands[0], r, predicted, values); });
            return bands;
        });
    }

    Field synthesise(const Coefficients& coefficients, const Synthesis& how) const override {
        return synthesise_levels(hierarchy(), coefficients, how,
                                 [&](std::size_t k, const std::vector<Subband>* d, double gain, Field& f) {
                                     with_details(d, gain, has_frames(f),
                                                  [&](const auto& odd, const auto&) { synthesise_level(k, odd, f); });
                                 });
    }

    std::size_t bytes() const override { return odd_.bytes(); }

private:
    template <class Value>
    void synthesise_level(std::size_t k, const Details<Value>& odd, Field& f) const {
        const Rings& rings = hierarchy().odd;
        predict_odd(hierarchy(), k, odd_, f,
                    [&](Index r, const double* predicted) { odd.add(r, predicted, f, f.row(rings.vertex(r))); });
    }

    Stencil odd_;
};

}  // namespace

SchemeRow lazy_scheme() {
    Capabilities can;
    can.local_frames = true;
    can.critically_sampled = true;
    can.even_rings = false;
    return {"Lazy",
            "vertices that stay keep their values and have no details: the least memory and time, but fine noise comes "
            "back in coarse levels",
            "<i>Sweldens</i>, <b>\"The Lifting Scheme: A Construction of Second Generation Wavelets\"</b>, SIAM "
            "Journal on Mathematical Analysis 1998",
            can, [](const Hierarchy& hierarchy, const SchemeOptions& options) -> std::unique_ptr<Scheme> {
                return std::make_unique<Lazy>(hierarchy, options);
            }};
}

}  // namespace multires
