#include "schemes/relaxed_rows.h"
#include "schemes/ring_update.h"
#include "schemes/table.h"

#include <memory>
#include <stdexcept>

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

    /// @param weight, flaps  of all entries
    /// @returns false if the vertex keeps its value
    bool row(const Rings& rings, Index r, const Positions& positions, double* weight, double* flaps) {
        const Star s = star(rings, r);
        weight += rings.offset[r];
        if (flaps) flaps += rings.offset[r];
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
        require_flaps(h.odd, options.op);
        weight_.resize(h.odd.neighbor.size());
        if (uses_flaps(options.op)) flap_weight_.resize(weight_.size());
        keeps_.resize(h.odd.rows());
        Positions positions = h.positions;
        Weigher weigher(options.op, updates());
        batches_.resize(h.levels.size());
        for (std::size_t k = 0; k < h.levels.size(); ++k) {
            if (h.levels[k].odd.size() != 1)
                batches_[k] = std::make_unique<Batches>(updates() ? ring_update::batches_of(h, k)
                                                                  : ring_update::sets_of(h.levels[k]));
            weigh(k, options.op, weigher, positions);
        }
        if (options.storage != Storage::single) return;
        narrow(weight_, single_);
        narrow(flap_weight_, flap_single_);
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
        std::size_t sum = part_.capacity() * sizeof(ring_update::Part) + keeps_.capacity() +
                          (weight_.capacity() + flap_weight_.capacity()) * sizeof(double) +
                          (single_.capacity() + flap_single_.capacity()) * sizeof(float) +
                          batches_.capacity() * sizeof(std::unique_ptr<Batches>);
        for (const auto& b : batches_)
            if (b) sum += sizeof(Batches) + (b->rows.capacity() + b->bounds.capacity()) * sizeof(Index);
        return sum;
    }

private:
    static constexpr Index grain = 256;

    static void require_flaps(const Rings& rings, Operator op) {
        if (uses_flaps(op) && rings.flap.size() != rings.neighbor.size())
            throw std::invalid_argument("Szczesna: the rings have no flaps");
    }
    static void narrow(Array<double>& wide, Array<float>& single) {
        single.assign(wide.begin(), wide.end());
        wide = Array<double>();
    }

    bool updates() const { return !part_.empty(); }

    const Batches& batches(std::size_t k) const {
        static const Batches one_row{{}, {0, 1}};
        return batches_[k] ? *batches_[k] : one_row;
    }

    RowWeights rows() const {
        const auto from = [&](const auto& all) { return all.empty() ? nullptr : all.data(); };
        return {&hierarchy().odd, from(weight_), from(flap_weight_), from(single_), from(flap_single_)};
    }

    template <class At>
    void update(const Rings& rings, Index row, int width, bool undo, const At& at) const {
        if (updates()) ring_update::update(rings, row, part_, width, undo, at);
    }

    /// Takes all rows of a level out of the positions, and makes the weights of each from what it leaves.
    /// @param shared  for batches too small to be worth one of their own
    void weigh(std::size_t k, Operator op, Weigher& shared, Positions& positions) {
        const Rings& odd = hierarchy().odd;
        const Batches& batches = this->batches(k);
        const Index first = hierarchy().levels[k].odd.begin;
        double* const flaps = flap_weight_.empty() ? nullptr : flap_weight_.data();
        const auto at = [&](Index place) { return positions[place].data(); };
        const auto run = [&](Index begin, Index end, Weigher& weigher) {
            for (Index i = begin; i < end; ++i) {
                const Index r = first + batches.row(i);
                update(odd, r, 3, false, at);
                keeps_[r] = !weigher.row(odd, r, positions, weight_.data(), flaps);
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
    }

    /// Calls take(row, room for a row's values) for all rows of a batch, in parallel.
    template <class Take>
    void for_batch(std::size_t k, std::size_t b, int width, const Take& take) const {
        const Batches& batches = this->batches(k);
        const Index first = batches.bounds[b], row = hierarchy().levels[k].odd.begin;
        parallel_chunks(batches.bounds[b + 1] - first, grain, [&](Index begin, Index end) {
            Field room = Field::unset(1, width);
            for (Index i = begin; i < end; ++i) take(row + batches.row(first + i), room.row(0));
        });
    }

    /// R f of an odd row; one that keeps its value is predicted by its parent.
    void predict(const RowWeights& weights, Index r, const Field& f, double* predicted) const {
        if (keeps_[r]) return copy_row(f.row(hierarchy().parent[weights.rings->vertex(r)]), f.width, predicted);
        row_sums(weights, r, r + 1, f.values.data(), f.width, predicted);
    }

    /// The details of a level; f, its values, becomes those of the coarser one.
    std::vector<Subband> analyse_level(std::size_t k, Field& f) const {
        const Rings& odd = hierarchy().odd;
        const RowWeights weights = rows();
        const auto at = [&](Index place) { return f.row(place); };
        std::vector<Subband> bands(1);
        bands[0].rings = &odd;
        bands[0].range = hierarchy().levels[k].odd;
        bands[0].values = Field::unset(bands[0].rows(), f.width);
        for (std::size_t b = batches(k).bounds.size() - 1; b-- > 0;)
            for_batch(k, b, f.width, [&](Index r, double* predicted) {
                update(odd, r, f.width, false, at);
                predict(weights, r, f, predicted);
                const double* const value = f.row(odd.vertex(r));
                double* const detail = bands[0].values.row(r - bands[0].range.begin);
                for (int c = 0; c < f.width; ++c) detail[c] = value[c] - predicted[c];
            });
        return bands;
    }

    /// The inverse of analyse_level.
    template <class Value>
    void synthesise_level(std::size_t k, const Details<Value>& details, Field& f) const {
        const Rings& odd = hierarchy().odd;
        const RowWeights weights = rows();
        const auto at = [&](Index place) { return f.row(place); };
        for (std::size_t b = 0; b + 1 < batches(k).bounds.size(); ++b)
            for_batch(k, b, f.width, [&](Index r, double* predicted) {
                predict(weights, r, f, predicted);
                details.add(r, predicted, f, f.row(odd.vertex(r)));
                update(odd, r, f.width, true, at);
            });
    }

    // A level may be one vertex: what all of them have is in one table, as it is in Hierarchy::odd.
    Array<ring_update::Part> part_;                  ///< #V; empty: no update
    std::vector<std::unique_ptr<Batches>> batches_;  ///< #levels; null: one row
    Array<double> weight_, flap_weight_;             ///< #entries
    Array<float> single_, flap_single_;              ///< the same with Storage::single
    Array<std::uint8_t> keeps_;                      ///< #odd rows: has no prediction but its parent
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
