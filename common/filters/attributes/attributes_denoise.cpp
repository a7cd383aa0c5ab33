#include "filters/attributes/attributes_denoise.h"

#include "denoise/field_noise.h"
#include "filters/attributes/attributes_automatic.h"
#include "filters/attributes/attributes_band.h"
#include "mesh/adjacency.h"
#include "mesh/validation.h"
#include "schemes/sure.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace multires {
namespace {

void check(const AttributeDenoiseOptions& o) {
    if (!(o.strength >= 0 && std::isfinite(o.strength))) throw InputError("strength must be a number, 0 or more");
    if (!(o.threshold >= 0 && std::isfinite(o.threshold))) throw InputError("threshold must be a number, 0 or more");
    if (o.finest_level < 0) throw InputError("finest_level must not be negative");
    if (o.coarsest_level <= o.finest_level) throw InputError("coarsest_level must be more than finest_level");
}

/// Levels [first, last) that share their statistics.
struct Group {
    std::size_t first = 0, last = 0;
};

std::vector<Group> group_levels(const Hierarchy& h, const AttributeDenoiseOptions& o) {
    const std::size_t end = std::min<std::size_t>(o.coarsest_level, h.levels.size());
    std::vector<Group> groups;
    for (std::size_t k = o.finest_level; k < end; ++k) {
        if (groups.empty() || h.size[k] <= 0.8 * h.size[groups.back().first]) groups.push_back({k, k});
        groups.back().last = k + 1;
    }
    return groups;
}

/// Channels that are shrunk together, as vectors.
struct Part {
    int begin = 0, width = 1;
    std::vector<double> noise;  ///< #width: deviation in each channel

    /// Root mean square over the channels.
    double deviation() const {
        double squares = 0;
        for (const double n : noise) squares += n * n;
        return std::sqrt(squares / width);
    }
};

/// A part of one subband of all levels of a group.
struct Details {
    std::vector<Field*> fields;
    int begin = 0, width = 1;  ///< channels

    template <class F>
    void each(const F& f) const {
        for (Field* field : fields)
            for (Index r = 0; r < field->rows(); ++r) f(field->row(r) + begin);
    }
    std::size_t rows() const {
        std::size_t n = 0;
        for (const Field* f : fields) n += f->rows();
        return n;
    }
    std::vector<double> lengths() const {
        std::vector<double> out;
        out.reserve(rows());
        each([&](const double* x) {
            double square = 0;
            for (int k = 0; k < width; ++k) square += x[k] * x[k];
            out.push_back(std::sqrt(square));
        });
        return out;
    }
};

Details details_of(Coefficients& c, const Group& group, std::size_t band, const Part& part) {
    Details d{{}, part.begin, part.width};
    for (std::size_t k = group.first; k < group.last; ++k) {
        Field& f = c.level[k][band].values;
        if (f.rows() > 0) d.fields.push_back(&f);
    }
    return d;
}

/// Root mean square of the noise gains of a group, weighted by its rows.
double gain_of(const NoiseGains& gains, const Coefficients& c, const Group& group, std::size_t band) {
    double squares = 0, rows = 0;
    for (std::size_t k = group.first; k < group.last; ++k) {
        const double g = gains[k][band], n = c.level[k][band].rows();
        squares += n * g * g;
        rows += n;
    }
    return rows > 0 ? std::sqrt(squares / rows) : 0;
}

Shrink shrink_rule(const AttributeDenoiseOptions& o) {
    return o.rule == AttributeRule::hard ? Shrink::hard : Shrink::soft;
}

/// By group and subband.
using Thresholds = std::vector<std::vector<double>>;

Thresholds thresholds_of(Coefficients& c, const std::vector<Group>& groups, const NoiseGains& gains, const Part& part,
                         const AttributeDenoiseOptions& o) {
    Thresholds t;
    for (const Group& group : groups) {
        t.emplace_back();
        for (std::size_t band = 0; band < c.level[group.first].size(); ++band) {
            const double noise = part.deviation() * gain_of(gains, c, group, band);
            t.back().push_back(o.automatic ? sure_threshold(details_of(c, group, band, part).lengths(), part.width,
                                                            noise, shrink_rule(o))
                                           : o.threshold);
        }
    }
    return t;
}

/// What was found and done at each group of levels.
struct Findings {
    std::vector<double> noise, threshold, zeroed;
};

/// Shrinks a part of all levels chosen.
Findings shrink_details(Coefficients& c, const std::vector<Group>& groups, const NoiseGains& gains, const Part& part,
                        const Thresholds& thresholds, double factor, Shrink rule) {
    Findings found;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        double noise = 0, threshold = 0, zeroed = 0, rows = 0;
        for (std::size_t band = 0; band < c.level[groups[g].first].size(); ++band) {
            const Details d = details_of(c, groups[g], band, part);
            const double n = static_cast<double>(d.rows()), t = factor * thresholds[g][band];
            // A threshold of zero changes nothing: what is zero already does not count as set to zero.
            if (t > 0) d.each([&](double* x) { zeroed += shrink(x, part.width, t, rule); });
            noise += n * part.deviation() * gain_of(gains, c, groups[g], band);
            threshold += n * t;
            rows += n;
        }
        found.noise.push_back(rows > 0 ? noise / rows : 0);
        found.threshold.push_back(rows > 0 ? threshold / rows : 0);
        found.zeroed.push_back(rows > 0 ? zeroed / rows : 0);
    }
    return found;
}

void report_findings(const std::string& label, double noise, const Findings& f, Report& report) {
    report.add(label + "_noise", noise);
    report.add(label + "_noise_per_level", f.noise);
    report.add(label + "_threshold", f.threshold);
    report.add(label + "_zeroed", f.zeroed);
}

/// Finds how far to shrink a part of a field: with the least estimated risk (Stein; by a random probe, as in
/// denoise/risk.h; analysis and synthesis are linear here).
class LeastRisk {
public:
    /// @param c  of the field
    LeastRisk(const Pyramid& pyramid, const Coefficients& c, const Part& part, int width)
        : pyramid_(pyramid), c_(c), probed_(c), part_(part), probe_(pyramid.hierarchy().vertices(), width) {
        probe_.has_positions = false;
        for (Index r = 0; r < probe_.rows(); ++r)
            for (int k = 0; k < part.width; ++k) probe_.row(r)[part.begin + k] = part.noise[k] * gaussian(r, 300 + k);
        const Coefficients probe = pyramid.scheme().analyse(probe_);
        const auto add = [](Field& to, const Field& from) {
            for (std::size_t i = 0; i < to.values.size(); ++i) to.values[i] += step * from.values[i];
        };
        add(probed_.base, probe.base);
        for (std::size_t k = 0; k < probe.level.size(); ++k)
            for (std::size_t b = 0; b < probe.level[k].size(); ++b)
                add(probed_.level[k][b].values, probe.level[k][b].values);
        before_ = pyramid.scheme().synthesise(c);
    }

    /// @param shrinks  void(Coefficients&, double factor)
    /// @returns 0 if no factor is clearly better than to leave the field as it is
    template <class Shrinks>
    double factor(const Shrinks& shrinks) const {
        constexpr std::array<double, 6> factors = {2, 1.4, 1, 0.7, 0.5, 0.25};
        double least = 0.9 - 3 / std::sqrt(static_cast<double>(probe_.rows())), best = 0;
        for (const double f : factors) {
            const double r = risk(f, shrinks);
            if (r < least) least = r, best = f;
        }
        return best;
    }

private:
    /// Mean square error expected, over that of the noise.
    template <class Shrinks>
    double risk(double factor, const Shrinks& shrinks) const {
        const auto shrunk = [&](Coefficients c) {
            shrinks(c, factor);
            return pyramid_.scheme().synthesise(c);
        };
        const Field after = shrunk(c_), other = shrunk(probed_);
        double noise = 0, sum = 0;
        for (Index r = 0; r < after.rows(); ++r)
            for (int k = 0; k < part_.width; ++k) {
                const int c = part_.begin + k;
                const double move = after.row(r)[c] - before_.row(r)[c], b = probe_.row(r)[c],
                             response = (other.row(r)[c] - after.row(r)[c]) / step - b,
                             square = part_.noise[k] * part_.noise[k];
                noise += square;
                sum += square + 2 * (b * response + b * b - square) + move * move;
            }
        return noise > 0 ? sum / noise : 1;
    }

    static constexpr double step = 0.5;  ///< of the noise: so large that the jumps of the hard rule are seen

    const Pyramid& pyramid_;
    const Coefficients& c_;
    Coefficients probed_;
    const Part& part_;
    Field probe_, before_;
};

/// The mesh as noise is measured on it.
struct SurfaceGeometry {
    Neighbours near;
    std::vector<double> weight;

    explicit SurfaceGeometry(const Mesh& mesh) {
        const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()));
        near = neighbours(mesh.faces, at);
        weight = cotangent_weights(mesh.faces, at, near, mesh.positions);
    }

    /// @param rounding  less than this is not taken for noise
    Part part(const Field& field, int begin, int width, double rounding) const {
        Part out{begin, width, {}};
        std::vector<double> values(field.rows());
        for (int c = begin; c < begin + width; ++c) {
            for (Index r = 0; r < field.rows(); ++r) values[r] = field.row(r)[c] - field.row(0)[c];
            const double noise = field_noise(near, weight, values);
            out.noise.push_back(noise > rounding ? noise : 0);
        }
        return out;
    }
};

Field denoised(const Channels& channels, const Pyramid& pyramid, const NoiseGains& gains,
               const SurfaceGeometry& surface, const AttributeDenoiseOptions& o, Report& report) {
    const std::vector<Group> groups = group_levels(pyramid.hierarchy(), o);
    const int width = channels.field.width, colors = width == 4 ? 3 : width;
    const double rounding = width == 4 ? 0.5 : 0;  // colours are whole numbers before and after
    bool changes = false;
    const auto denoise_part = [&](Coefficients& c, const Part& part) {
        const Thresholds t = thresholds_of(c, groups, gains, part, o);
        double factor = 1;
        if (o.automatic && part.deviation() > 0 && o.strength > 0)
            factor = o.strength * LeastRisk(pyramid, c, part, width).factor([&](Coefficients& to, double f) {
                shrink_details(to, groups, gains, part, t, f, shrink_rule(o));
            });
        else if (o.automatic)
            factor = 0;
        changes = changes || factor > 0;
        return shrink_details(c, groups, gains, part, t, factor, shrink_rule(o));
    };
    Field after = through_pyramid(pyramid, channels.field, [&](Coefficients& c) {
        const Part part = surface.part(channels.field, 0, colors, rounding);
        report_findings(channels.label, part.deviation(), denoise_part(c, part), report);
        if (width == 4) denoise_part(c, surface.part(channels.field, 3, 1, rounding));
        return pyramid.scheme().synthesise(c);
    });
    return changes ? after : channels.field;
}

Result by_risk(const Layer& layer, const AttributeDenoiseOptions& options, const std::vector<Channels>& all,
               const Session& session) {
    Result result;
    const std::vector<double> weights = region_weights(layer, options.region);
    session.progress.report(0.02, "Finding neighbours");
    const ValueSurface surface(layer.mesh);
    for (std::size_t k = 0; k < all.size(); ++k) {
        const Field after = denoised_automatically(surface, all[k], options.strength, result.report, [&](double f) {
            session.progress.report(0.05 + 0.9 * (static_cast<double>(k) + f) / static_cast<double>(all.size()),
                                    "Denoising attributes");
        });
        result.attributes.push_back(changed_attribute(layer, all[k], after, weights, result.report));
    }
    return result;
}

}  // namespace

Result denoise_attributes(const Layer& layer, const AttributeDenoiseOptions& options, Session& session) {
    check(options);
    require_usable(layer.mesh);
    const std::vector<Channels> all = vertex_channels(layer, options.what, options.linear_light);
    if (options.rule == AttributeRule::automatic && options.automatic) return by_risk(layer, options, all, session);
    Result result;
    const auto pyramid = pyramid_of(layer, options.pyramid, session, result.report);
    const std::vector<double> weights = region_weights(layer, options.region);
    session.progress.report(0.9, "Measuring the noise");
    const NoiseGains gains = noise_gains(pyramid->hierarchy(), pyramid->scheme());
    const SurfaceGeometry surface(layer.mesh);
    for (const Channels& c : all) {
        session.progress.report(0.92, "Denoising attributes");
        const Field after = denoised(c, *pyramid, gains, surface, options, result.report);
        result.attributes.push_back(changed_attribute(layer, c, after, weights, result.report));
    }
    return result;
}

}  // namespace multires
