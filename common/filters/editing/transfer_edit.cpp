#include "filters/editing/transfer_edit.h"

#include "base/parallel.h"
#include "base/reduce.h"
#include "editing/gradient_domain.h"
#include "editing/soft_border.h"
#include "filters/editing/bands.h"
#include "filters/editing/proxies.h"
#include "mesh/validation.h"

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

/// The distance that a tenth of the vertices keep within.
double nearest_tenth(const Array<Foot>& feet) {
    std::vector<double> squared(feet.size());
    for (std::size_t i = 0; i < feet.size(); ++i) squared[i] = feet[i].squared;
    const auto at = squared.begin() + static_cast<std::ptrdiff_t>(squared.size() / 10);
    std::nth_element(squared.begin(), at, squared.end());
    return std::sqrt(*at);
}

/// Of a mesh with so many times more vertices than the proxy. Averages over a fifth of the proxy's edges; beyond 8
/// steps nothing is gained.
GradientDomainOptions gradient_options(double vertices, double proxy_vertices) {
    GradientDomainOptions options;
    options.smoothing = static_cast<int>(std::clamp(std::round(0.2 * vertices / proxy_vertices), 1.0, 8.0));
    return options;
}

/// Gains that change only what is finer than a level.
std::vector<double> gains_below(const Hierarchy& h, std::size_t level, double gain) {
    std::vector<double> gains(h.levels.size(), 1);
    std::fill_n(gains.begin(), level, gain);
    return gains;
}

/// One call of the filter.
class Transfer {
public:
    Transfer(const Layer& layer, const TransferEditOptions& options, const FoundProxy& found, Session& session,
             Report& report)
        : layer_(layer), options_(options), found_(found), session_(session), report_(report) {}

    Positions positions() {
        const Progress whole = session_.progress;
        gradients_ = displacement_gradients(found_.proxy());
        feet_ = feet_of(layer_.mesh.positions, found_.faces, found_.before, whole.part(0.1, 0.4));
        require_near(layer_, found_, nearest_tenth(feet_));
        motion_ = motion_at(layer_.mesh.positions, feet_, found_.proxy(), gradients_);
        session_.progress = whole.part(0.4, 0.9);
        Positions after = moved();
        session_.progress = whole;
        report_.add("proxy_distance", distance(), "mesh units");
        report_.add("folded_faces", folded(after));
        return after;
    }

private:
    Positions moved() {
        if (options_.encoding == Encoding::frames) return by_frames();
        if (options_.encoding == Encoding::gradient) return by_gradients();
        return options_.bands == 1 ? over_proxy() : over_bases();
    }

    bool other_details() const { return options_.gain != 1 || options_.details != DetailsFollow::multiresolution; }

    /// RMS distance of the vertices to the proxy.
    double distance() const {
        return chunked_fold<Lengths>(feet_.size(), [&](Lengths& part, std::size_t i) { part.add(feet_[i].squared); })
            .rms();
    }

    Positions by_gradients() {
        const GradientDomainOptions how = gradient_options(static_cast<double>(layer_.mesh.positions.size()),
                                                           static_cast<double>(found_.before.size()));
        const Progress whole = session_.progress;
        Positions after = gradient_domain(layer_.mesh, motion_, how, whole.part(0, other_details() ? 0.5 : 1));
        parallel_for(static_cast<Index>(after.size()), [&](Index i) {
            const Vec3& p = layer_.mesh.positions[i];
            after[i] = after[i] == Vec3::Zero() ? p : Vec3(p + after[i]);
        });
        session_.progress = whole.part(0.5, 1);
        if (other_details()) change_details(after);
        session_.progress = whole;
        return after;
    }

    /// Detail d = x - base becomes gain x (what it is to be) from (I + G) d.
    void change_details(Positions& after) {
        const auto pyramid = pyramid_of(layer_, options_.pyramid, session_, report_);
        const std::size_t level = nearest_level(pyramid->hierarchy(), found_.before.size());
        const Positions base = pyramid->synthesise(gains_below(pyramid->hierarchy(), level, 0));
        const double gain = options_.details == DetailsFollow::none ? 0 : options_.gain;
        const bool turn = options_.details == DetailsFollow::multiresolution;
        parallel_for(static_cast<Index>(after.size()), [&](Index i) {
            const Vec3 d = layer_.mesh.positions[i] - base[i], turned = motion_.gradient[i] * d;
            after[i] += (gain - 1) * d + (turn ? gain - 1 : -1.0) * turned;
        });
    }

    Positions by_frames() {
        const auto pyramid = pyramid_of(layer_, options_.pyramid, session_, report_);
        const Hierarchy& h = pyramid->hierarchy();
        const std::size_t level = nearest_level(h, found_.before.size());
        const Positions coarse =
            carried(positions_of(pyramid->scheme().synthesise(pyramid->coefficients(), down_to(level))));
        const bool turn = options_.details == DetailsFollow::multiresolution;
        const Field values = field_of(coarse);
        Synthesis how = starting_at(level, values);
        how.gain = gains_below(h, level, turn ? options_.gain : 0);
        Positions after = positions_in_input(h, pyramid->scheme().synthesise(pyramid->coefficients(), how));
        if (options_.details == DetailsFollow::single) {
            const Positions base = pyramid->synthesise(gains_below(h, level, 0));
            for (std::size_t i = 0; i < after.size(); ++i)
                after[i] += options_.gain * (layer_.mesh.positions[i] - base[i]);
        }
        return after;
    }

    /// Where the motion of the proxy takes a shape of the layer.
    Positions carried(Positions shape) const {
        const Array<Foot> feet = feet_of(shape, found_.faces, found_.before, session_.progress.part(0.8, 0.9));
        const Motion motion = motion_at(shape, feet, found_.proxy(), gradients_);
        for (std::size_t i = 0; i < shape.size(); ++i) shape[i] += motion.displacement[i];
        return shape;
    }

    /// Every vertex over its base point on the proxy.
    Positions over_proxy() {
        const PhongSurface before(found_.faces, found_.before), after(found_.faces, found_.after);
        Array<Index> starts(feet_.size());
        for (std::size_t i = 0; i < feet_.size(); ++i) starts[i] = feet_[i].face;
        BasePoints found = base_points(before, layer_.mesh.positions, starts, session_.progress);
        report_.add("border_points", static_cast<int>(found.border));
        report_.add("nearest_points", static_cast<int>(found.nearest));
        const bool turn = options_.details == DetailsFollow::multiresolution;
        const double gain = options_.details == DetailsFollow::none ? 0 : options_.gain;
        Positions out(feet_.size());
        parallel_for(static_cast<Index>(out.size()), [&](Index i) {
            BasePoint& b = found.points[i];
            const Vec3 detail = layer_.mesh.positions[i] - before.base(b.face, b.weight);
            b.detail *= turn ? gain : 0;
            out[i] = after.place(b) + (turn ? 0 : gain) * detail;
        });
        return out;
    }

    /// How many vertices of the layer a base leaves where they are.
    Index kept_by(const Positions& base) const {
        Index count = 0;
        for (std::size_t i = 0; i < base.size(); ++i) count += base[i] == layer_.mesh.positions[i];
        return count;
    }

    /// A smooth base moves, and bands of detail follow.
    Positions over_bases() {
        const Progress whole = session_.progress;
        session_.progress = whole.part(0, 0.2);
        const auto pyramid = pyramid_of(layer_, options_.pyramid, session_, report_);
        session_.progress = whole;
        const Hierarchy& h = pyramid->hierarchy();
        // A smooth base of this layer has all its vertices: it is the coarsest one, and edited by hand.
        const bool own = found_.before.size() == layer_.mesh.positions.size() && found_.faces == layer_.mesh.faces;
        const auto coarsest = std::clamp(own ? kept_by(found_.before) : static_cast<Index>(found_.before.size()),
                                         h.size.back(), h.vertices());
        const std::vector<Index> kept = kept_by_bases(*pyramid, BandLevels::ratio, options_.bands - 1, coarsest);
        const Multiband bands =
            multiband_of(layer_.mesh, *pyramid, kept, own ? &found_.before : nullptr, whole.part(0.2, 0.8));
        report_bands(bands, kept, report_);
        const Positions base = own ? found_.after : carried(bands.coarsest());
        if (options_.details != DetailsFollow::single) {
            const double gain = options_.details == DetailsFollow::none ? 0 : options_.gain;
            return bands.reconstruct(base, std::vector<double>(bands.bands(), gain));
        }
        Positions after = base;
        for (std::size_t i = 0; i < after.size(); ++i)
            after[i] += options_.gain * (layer_.mesh.positions[i] - bands.coarsest()[i]);
        return after;
    }

    /// Faces whose normal points against that which the motion of the surface gives them.
    int folded(const Positions& after) const {
        const Faces& faces = layer_.mesh.faces;
        const Positions& p = layer_.mesh.positions;
        return static_cast<int>(chunked_fold<Mean>(faces.size(), [&](Mean& part, std::size_t i) {
                                    const Face& f = faces[i];
                                    const Mat3 g =
                                        Mat3::Identity() +
                                        (motion_.gradient[f[0]] + motion_.gradient[f[1]] + motion_.gradient[f[2]]) / 3;
                                    const Vec3 expected = (g * (p[f[1]] - p[f[0]])).cross(g * (p[f[2]] - p[f[0]]));
                                    const Vec3 n = (after[f[1]] - after[f[0]]).cross(after[f[2]] - after[f[0]]);
                                    if (n.dot(expected) < 0) part.add(1);
                                }).sum);
    }

    const Layer& layer_;
    const TransferEditOptions& options_;
    const FoundProxy& found_;
    Session& session_;
    Report& report_;
    Array<Mat3> gradients_;  // of the proxy
    Array<Foot> feet_;       // of the layer's vertices
    Motion motion_;          // of the layer's vertices
};

}  // namespace

Result transfer_edit(const Inputs& inputs, const TransferEditOptions& options, Session& session) {
    const Layer& layer = inputs.current;
    require_usable(layer.mesh);
    check(options);
    Result result;
    std::vector<double> weights = region_weights(layer, options.region);
    if (options.region.selected) soften_border(layer.mesh, options.soft_border, weights);
    const Progress whole = session.progress;
    session.progress = whole.part(0, 0.1);
    const FoundProxy found = find_proxy(inputs, options, session, result.report);
    session.progress = whole.part(0.1, 0.95);
    result.report.say("Following " + found.text + ".");
    result.report.add("way", static_cast<int>(found.way));
    const bool same = found.unchanged && options.gain == 1 && options.details != DetailsFollow::none;
    Positions after = layer.mesh.positions;
    if (same) {
        result.report.say("The proxy is the same before and after: nothing moves.");
        result.report.add("proxy_distance", 0.0, "mesh units");
        result.report.add("folded_faces", 0);
    } else {
        after = Transfer(layer, options, found, session, result.report).positions();
    }
    session.progress = whole;
    whole.report(0.96, "Measuring the change");
    blend(layer.mesh.positions, weights, after);
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    return result;
}

}  // namespace multires
