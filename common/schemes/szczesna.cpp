#include "schemes/relaxed_rows.h"
#include "schemes/ring_update.h"
#include "schemes/table.h"

// Lifting with the update first (Szczesna 2011), one vertex after the other, with U of ring_update.h and a relaxation
// operator R, the chapter's or another:
//
//     analysis   f_ring += U(f_v, f_ring)
//                d       = f_v - R f
//     synthesis  f_v     = d + R f
//                f_ring -= U(f_v, f_ring)
//
// Coarse levels are means, not subsets, so fine waves come back in them far weaker than with lazy.cpp, at no more
// coefficients. The weights of R come from positions that carry the same updates: where values are linear functions of
// positions, they still are when v is predicted. The chapter's own predictors have no local frames, and neither has
// this; nothing but rows of one set is regrouped (see Batches), and sequential levels are the chapter's order.
//
// The update may fold a star over itself, where areas and angles mislead: such rows take the weights of natural
// neighbours, which know no triangles.
//
// The chapter has closed meshes only. Boundaries and creases are curves of their own here: they are updated from
// vertices along them, and from nothing else.

namespace multires {
namespace {

using namespace relaxed_rows;
using ring_update::Batches;
using ring_update::Part;

RelaxationOptions relaxation_of(Operator op) {
    RelaxationOptions options;
    options.op = op;
    return options;
}

/// True if a triangle of a closed star faces away from the ring.
bool is_folded(const Star& star, const Positions& p) {
    if (star.kind != RingKind::closed) return false;
    const auto spoke = [&](Index j) -> Vec3 { return p[star.neighbor[j < star.size ? j : 0]] - p[star.vertex]; };
    Vec3 area(0, 0, 0);
    for (Index j = 0; j < star.size; ++j) area += spoke(j).cross(spoke(j + 1));
    double least = 0;
    for (Index j = 0; j < star.size; ++j) least = std::min(least, spoke(j).cross(spoke(j + 1)).dot(area));
    return least < -1e-10 * area.squaredNorm();
}

/// Makes weights of single rows; one object per thread.
class Weigher {
public:
    /// @param may_fold  the positions are not the mesh's
    Weigher(Operator op, bool may_fold)
        : may_fold_(may_fold && op != Operator::umbrella), relaxation_(relaxation_of(op)),
          natural_(relaxation_of(Operator::natural_neighbours)) {}

    /// @returns false if the vertex keeps its value
    bool row(const Rings& rings, Index r, const Positions& positions, RingWeights& weights) {
        const Star s = star(rings, r);
        double* const weight = weights.weight.data() + rings.offset[r];
        double* const flaps = weights.flap_weight.empty() ? nullptr : weights.flap_weight.data() + rings.offset[r];
        return (may_fold_ && is_folded(s, positions) ? natural_ : relaxation_).row(s, positions, weight, flaps);
    }

private:
    bool may_fold_;
    RowRelaxation relaxation_, natural_;
};

class Szczesna final : public Scheme {
public:
    Szczesna(const Hierarchy& h, const SchemeOptions& options) : Scheme(h) {
        if (options.update == Update::mean) part_ = ring_update::parts_of(h);
        Positions positions = h.positions;
        Weigher weigher(options.op, updates());
        for (const Level& level : h.levels) {
            batches_.push_back(updates() ? ring_update::batches_of(level) : Batches{{}, level.sets});
            RingWeights weights = unset_weights(level.odd, options.op);
            weigh(level.odd, batches_.back(), options.op, weigher, positions, weights);
            odd_.emplace_back(level.odd, std::move(weights), options.storage);
        }
    }

    Coefficients analyse(Field f, Storage storage) const override {
        return analyse_levels(hierarchy(), std::move(f), storage,
                              [&](std::size_t k, Field& values) { return analyse_level(k, values); });
    }

    Field synthesise(const Coefficients& coefficients, const Synthesis& how) const override {
        return synthesise_levels(
            hierarchy(), coefficients, how, [&](std::size_t k, const std::vector<Subband>* d, double gain, Field& f) {
                with_details(d, gain, false, [&](const auto& odd, const auto&) { synthesise_level(k, odd, f); });
            });
    }

    std::size_t bytes() const override {
        std::size_t sum =
            relaxed_rows::bytes(odd_) + part_.capacity() * sizeof(Part) + batches_.capacity() * sizeof(Batches);
        for (const Batches& b : batches_) sum += (b.rows.capacity() + b.bounds.capacity()) * sizeof(Index);
        return sum;
    }

private:
    static constexpr Index grain = 256;

    bool updates() const { return !part_.empty(); }

    template <class At>
    void update(const Rings& rings, Index row, int width, bool undo, const At& at) const {
        if (updates()) ring_update::update(rings, row, part_, width, undo, at);
    }

    /// Takes all rows of a level out of the positions, and makes the weights of each from what it leaves.
    /// @param shared  for batches too small to be worth one of their own
    void weigh(const Rings& odd, const Batches& batches, Operator op, Weigher& shared, Positions& positions,
               RingWeights& weights) const {
        Array<std::uint8_t> keeps(odd.rows());
        const auto at = [&](Index place) { return positions[place].data(); };
        const auto run = [&](Index begin, Index end, Weigher& weigher) {
            for (Index i = begin; i < end; ++i) {
                const Index r = batches.row(i);
                update(odd, r, 3, false, at);
                keeps[r] = !weigher.row(odd, r, positions, weights);
            }
        };
        for (std::size_t b = batches.bounds.size() - 1; b-- > 0;) {
            const Index begin = batches.bounds[b], count = batches.bounds[b + 1] - begin;
            if (count <= grain)
                run(begin, begin + count, shared);
            else
                parallel_chunks(count, grain, [&](Index from, Index to) {
                    Weigher weigher(op, updates());
                    run(begin + from, begin + to, weigher);
                });
        }
        for (Index r = 0; r < odd.rows(); ++r)
            if (keeps[r]) weights.fixed.push_back(r);
    }

    /// Calls take(row, room for a row's values) for all rows of a batch, in parallel.
    template <class Take>
    void for_batch(std::size_t k, std::size_t b, int width, const Take& take) const {
        const Batches& batches = batches_[k];
        const Index first = batches.bounds[b];
        parallel_chunks(batches.bounds[b + 1] - first, grain, [&](Index begin, Index end) {
            Field room = Field::unset(1, width);
            for (Index i = begin; i < end; ++i) take(batches.row(first + i), room.row(0));
        });
    }

    /// R f of an odd row; one that keeps its value is predicted by its parent.
    void predict(std::size_t k, const RowWeights& weights, Index r, const Field& f, double* predicted) const {
        const std::vector<Index>& fixed = odd_[k].fixed();
        if (!fixed.empty() && std::binary_search(fixed.begin(), fixed.end(), r))
            return copy_row(f.row(hierarchy().parent[hierarchy().levels[k].coarse + r]), f.width, predicted);
        row_sums(weights, r, r + 1, f.values.data(), f.width, predicted);
    }

    /// The details of a level; f, its values, becomes those of the coarser one.
    std::vector<Subband> analyse_level(std::size_t k, Field& f) const {
        const Rings& odd = hierarchy().levels[k].odd;
        const RowWeights weights = odd_[k].rows();
        const auto at = [&](Index place) { return f.row(place); };
        std::vector<Subband> bands(1);
        bands[0].rings = &odd;
        bands[0].values = Field::unset(odd.rows(), f.width);
        for (std::size_t b = batches_[k].bounds.size() - 1; b-- > 0;)
            for_batch(k, b, f.width, [&](Index r, double* predicted) {
                update(odd, r, f.width, false, at);
                predict(k, weights, r, f, predicted);
                const double* const value = f.row(odd.vertex(r));
                for (int c = 0; c < f.width; ++c) bands[0].values.row(r)[c] = value[c] - predicted[c];
            });
        return bands;
    }

    /// The inverse of analyse_level.
    template <class Value>
    void synthesise_level(std::size_t k, const Details<Value>& details, Field& f) const {
        const Rings& odd = hierarchy().levels[k].odd;
        const RowWeights weights = odd_[k].rows();
        const auto at = [&](Index place) { return f.row(place); };
        for (std::size_t b = 0; b + 1 < batches_[k].bounds.size(); ++b)
            for_batch(k, b, f.width, [&](Index r, double* predicted) {
                predict(k, weights, r, f, predicted);
                details.add(r, predicted, f, f.row(odd.vertex(r)));
                update(odd, r, f.width, true, at);
            });
    }

    Array<Part> part_;              ///< #V; empty: no update
    std::vector<Batches> batches_;  ///< #levels
    std::vector<Stencil> odd_;
};

}  // namespace

SchemeRow szczesna_scheme() {
    Capabilities can;
    can.critically_sampled = true;
    can.even_rings = false;
    return {"Szczesna",
            "lifting that hands the mean of what goes to what stays: no more details than vertices, in world axes, and "
            "coarse levels that are means",
            "<i>Szcz&#281;sna</i>, <b>\"The Multiresolution Wavelet-Based Transformation of 3D Object Surface "
            "Meshes\"</b>, in: Wavelets: Classification, Theory and Applications, Nova Science 2011",
            can, [](const Hierarchy& hierarchy, const SchemeOptions& options) -> std::unique_ptr<Scheme> {
                return std::make_unique<Szczesna>(hierarchy, options);
            }};
}

}  // namespace multires
