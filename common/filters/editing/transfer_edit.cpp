#include "filters/editing/transfer_edit.h"

#include "base/hash.h"
#include "base/parallel.h"
#include "base/reduce.h"
#include "editing/soft_border.h"
#include "filters/editing/bands.h"
#include "filters/editing/followed.h"
#include "measure/vertex_normals.h"
#include "mesh/validation.h"
#include "pyramid/pyramid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace multires {
namespace {

void check(const TransferEditOptions& options) {
    require(std::isfinite(options.gain), "gain must be a number");
    require(options.bands >= 1 && options.bands <= most_bands, "bands must be 1 to " + std::to_string(most_bands));
    require(options.soft_border >= 0 && std::isfinite(options.soft_border), "soft_border must be a number, 0 or more");
}

/// Gains that change only what is finer than a level.
std::vector<double> gains_below(const Hierarchy& h, std::size_t level, double gain) {
    std::vector<double> gains(h.levels.size(), 1);
    std::fill_n(gains.begin(), level, gain);
    return gains;
}

/// What is finer than a level of the pyramid, #V by 3; kept with the layer, too.
class FineDetail final : public Intermediate {
public:
    using Intermediate::Intermediate;
    std::size_t bytes() const override { return sizeof *this + vectors.capacity() * sizeof(Vec3); }

    Positions vectors;
};

std::shared_ptr<const FineDetail> fine_detail(const Layer& layer, const Pyramid& pyramid, std::size_t level,
                                              IntermediateCache& cache) {
    Hash hash;
    hash.add(std::array<std::uint64_t, 2>{static_cast<std::uint64_t>(IntermediateKind::fine_detail), level});
    hash.add(pyramid.hash());
    return find_or_make<FineDetail>(cache, hash.bits128(), pyramid.shape(), [&] {
        auto detail = std::make_shared<FineDetail>(hash.bits128(), pyramid.shape());
        detail->vectors = pyramid.synthesise(gains_below(pyramid.hierarchy(), level, 0));
        parallel_for(static_cast<Index>(detail->vectors.size()),
                     [&](Index i) { detail->vectors[i] = layer.mesh.positions[i] - detail->vectors[i]; });
        return detail;
    });
}

/// Puts the layer together from what was solved, with the gain and what becomes of details.
class Finish {
public:
    Finish(const Layer& layer, const TransferEditOptions& options, const FollowedEdit& edit, Session& session,
           Report& report)
        : layer_(layer), options_(options), edit_(edit), session_(session), report_(report),
          gain_(options.details == DetailsFollow::none ? 0 : options.gain),
          turn_(options.details != DetailsFollow::single) {}

    Positions positions() {
        if (options_.encoding == Encoding::frames) return over_level();
        if (options_.encoding == Encoding::gradient) return gain_ == 1 && turn_ ? edit_.shape : with_details_changed();
        return edit_.bands ? over_bases() : over_proxy();
    }

private:
    /// Detail d = x - base becomes gain x (what it is to be) from (I + G) d.
    Positions with_details_changed() {
        const auto pyramid = pyramid_of(layer_, options_.pyramid, session_, report_);
        const std::size_t level = nearest_level(pyramid->hierarchy(), edit_.proxy_vertices);
        const auto detail = fine_detail(layer_, *pyramid, level, session_.intermediates);
        Positions after(edit_.shape.size());
        parallel_for(static_cast<Index>(after.size()), [&](Index i) {
            const Vec3 &d = detail->vectors[i], turned = edit_.gradient[i] * d;
            after[i] = edit_.shape[i] + (gain_ - 1) * d + (turn_ ? gain_ - 1 : -1.0) * turned;
        });
        return after;
    }

    Positions over_level() {
        const auto pyramid = pyramid_of(layer_, options_.pyramid, session_, report_);
        require_starts_anywhere(options_.pyramid.scheme);
        const Hierarchy& h = pyramid->hierarchy();
        const std::size_t level = nearest_level(h, edit_.proxy_vertices);
        const Field values = field_of(edit_.shape);
        Synthesis how = starting_at(level, values);
        how.gain = gains_below(h, level, turn_ ? gain_ : 0);
        Positions after = positions_in_input(h, pyramid->scheme().synthesise(pyramid->coefficients(), how));
        if (!turn_) add_standing(fine_detail(layer_, *pyramid, level, session_.intermediates)->vectors, after);
        return after;
    }

    Positions over_proxy() {
        report_.add("border_points", static_cast<int>(edit_.border));
        report_.add("nearest_points", static_cast<int>(edit_.nearest));
        Positions after = edit_.shape;
        add_standing(turn_ ? edit_.turned : edit_.detail, after);
        return after;
    }

    Positions over_bases() {
        report_bands(*edit_.bands, edit_.kept, report_);
        if (turn_)
            return edit_.bands->reconstruct(layer_.mesh.faces, edit_.shape,
                                            std::vector<double>(edit_.bands->bands(), gain_));
        Positions after = edit_.shape;
        const Positions& base = edit_.bands->coarsest();
        for (std::size_t i = 0; i < after.size(); ++i) after[i] += gain_ * (layer_.mesh.positions[i] - base[i]);
        return after;
    }

    void add_standing(const Positions& detail, Positions& after) const {
        parallel_for(static_cast<Index>(after.size()), [&](Index i) { after[i] += gain_ * detail[i]; });
    }

    const Layer& layer_;
    const TransferEditOptions& options_;
    const FollowedEdit& edit_;
    Session& session_;
    Report& report_;
    double gain_;
    bool turn_;
};

/// Faces whose normal points against that which the motion of the surface gives them.
int folded(const Mesh& mesh, const Array<Mat3>& gradient, const Positions& after) {
    const Positions& p = mesh.positions;
    return static_cast<int>(chunked_fold<Mean>(mesh.faces.size(), [&](Mean& part, std::size_t i) {
                                const Face& f = mesh.faces[i];
                                const Mat3 g =
                                    Mat3::Identity() + (gradient[f[0]] + gradient[f[1]] + gradient[f[2]]) / 3;
                                const Vec3 expected = (g * (p[f[1]] - p[f[0]])).cross(g * (p[f[2]] - p[f[0]]));
                                if (area_vector(f, after).dot(expected) < 0) part.add(1);
                            }).sum);
}

/// The edit from the cache, or solved now. Null: nothing was changed, and details are to stay as they are.
std::shared_ptr<const FollowedEdit> edit_of(const Inputs& inputs, const TransferEditOptions& options, Session& session,
                                            Report& report) {
    const ContentHash hash = followed_hash(inputs, options);
    auto edit = std::static_pointer_cast<const FollowedEdit>(session.intermediates.find(hash));
    std::optional<FoundProxy> found;
    const Progress whole = session.progress;
    if (!edit) {
        session.progress = whole.part(0, 0.1);
        found = find_proxy(inputs, options, session, report);
    }
    report.say("Following " + (edit ? edit->text : found->text) + ".");
    report.add("way", static_cast<int>(edit ? edit->way : found->way));
    const bool unchanged = edit ? edit->unchanged : found->unchanged;
    if (unchanged && options.gain == 1 && options.details != DetailsFollow::none) return nullptr;
    session.progress = whole.part(0.1, 0.7);
    if (!edit) edit = solve_edit(inputs.current, options, *found, hash, session, report);
    session.progress = whole.part(0.7, 1);
    return edit;
}

}  // namespace

Result transfer_edit(const Inputs& inputs, const TransferEditOptions& options, Session& session) {
    const Layer& layer = inputs.current;
    require_usable(layer.mesh);
    check(options);
    Result result;
    std::vector<double> weights = region_weights(layer, options.region);
    if (options.region.selected) soften_border(layer.mesh, options.soft_border, weights);
    const Progress whole = session.progress;
    session.progress = whole.part(0, 0.95);
    Positions after;
    if (const auto edit = edit_of(inputs, options, session, result.report)) {
        after = Finish(layer, options, *edit, session, result.report).positions();
        result.report.add("proxy_distance", edit->distance, "mesh units");
        result.report.add("folded_faces", folded(layer.mesh, edit->gradient, after));
    } else {
        after = layer.mesh.positions;
        result.report.say("The proxy is the same before and after: nothing moves.");
        result.report.add("proxy_distance", 0.0, "mesh units");
        result.report.add("folded_faces", 0);
    }
    session.progress = whole;
    whole.report(0.96, "Measuring the change");
    blend(layer.mesh.positions, weights, after);
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    return result;
}

}  // namespace multires
