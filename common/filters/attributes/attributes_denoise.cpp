#include "filters/attributes/attributes_denoise.h"

#include "filters/attributes/attributes_band.h"
#include "mesh/validation.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// Some channels of one subband of all levels of a group.
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
};

Details details_of(Coefficients& c, const Group& group, std::size_t band, int begin, int width) {
    Details d{{}, begin, width};
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

/// Deviation of the noise in one channel of the input, from the finest details: root mean square over the channels. All
/// subbands show the same noise with different shares of the signal, which only adds: the smallest one counts.
double noise_of(Coefficients& c, const NoiseGains& gains, const Hierarchy& h, int begin, int width) {
    const std::vector<Group> groups = group_levels(h, {});
    if (groups.empty()) return 0;
    double squares = 0;
    for (int channel = begin; channel < begin + width; ++channel) {
        double deviation = std::numeric_limits<double>::infinity();
        for (std::size_t band = 0; band < c.level[0].size(); ++band) {
            const Details d = details_of(c, groups[0], band, channel, 1);
            const double g = gain_of(gains, c, groups[0], band);
            if (g <= 0 || d.rows() < 8) continue;
            std::vector<double> values;
            d.each([&](const double* x) { values.push_back(*x); });
            deviation = std::min(deviation, deviation_by_median(values) / g);
        }
        if (std::isfinite(deviation)) squares += deviation * deviation;
    }
    return std::sqrt(squares / width);
}

double automatic_threshold(const Details& d, double noise, const AttributeDenoiseOptions& o) {
    if (noise <= 0) return 0;
    const double length = o.strength * std::sqrt(static_cast<double>(d.width));
    if (o.rule == Shrink::hard) return 3 * noise * length;
    double squares = 0, largest = 0;
    d.each([&](const double* x) {
        double square = 0;
        for (int k = 0; k < d.width; ++k) square += x[k] * x[k];
        squares += square;
        largest = std::max(largest, square);
    });
    const double variance = squares / static_cast<double>(d.rows() * d.width), signal = variance - noise * noise;
    // No signal: everything goes, but no more than a factor of `strength` asks for.
    const double all = std::sqrt(largest) * std::min(1.0, o.strength);
    return signal > 0 ? std::min(all, noise * noise / std::sqrt(signal) * length) : all;
}

/// What was found and done at each group of levels.
struct Findings {
    std::vector<double> noise, threshold, zeroed;
};

/// Thresholds some channels of all levels chosen.
Findings shrink_details(Coefficients& c, const Hierarchy& h, const NoiseGains& gains, double noise, int begin,
                        int width, const AttributeDenoiseOptions& o) {
    Findings found;
    for (const Group& group : group_levels(h, o)) {
        double level_noise = 0, level_threshold = 0, zeroed = 0, rows = 0;
        for (std::size_t band = 0; band < c.level[group.first].size(); ++band) {
            const Details d = details_of(c, group, band, begin, width);
            const double n = static_cast<double>(d.rows()), here = noise * gain_of(gains, c, group, band);
            const double t = o.automatic ? automatic_threshold(d, here, o) : o.threshold;
            // A threshold of zero changes nothing: what is zero already does not count as set to zero.
            if (t > 0) d.each([&](double* x) { zeroed += shrink(x, width, t, o.rule); });
            level_noise += n * here;
            level_threshold += n * t;
            rows += n;
        }
        found.noise.push_back(rows > 0 ? level_noise / rows : 0);
        found.threshold.push_back(rows > 0 ? level_threshold / rows : 0);
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

Field denoised(const Channels& channels, const Pyramid& pyramid, const NoiseGains& gains,
               const AttributeDenoiseOptions& o, Report& report) {
    const Hierarchy& h = pyramid.hierarchy();
    return through_pyramid(pyramid, channels.field, {}, [&](Coefficients& c) {
        const int width = channels.field.width, colors = width == 4 ? 3 : width;
        const double noise = noise_of(c, gains, h, 0, colors);
        report_findings(channels.label, noise, shrink_details(c, h, gains, noise, 0, colors, o), report);
        if (width == 4) shrink_details(c, h, gains, noise_of(c, gains, h, 3, 1), 3, 1, o);
    });
}

}  // namespace

Result denoise_attributes(const Layer& layer, const AttributeDenoiseOptions& options, Session& session) {
    check(options);
    require_usable(layer.mesh);
    const std::vector<Channels> all = vertex_channels(layer, options.what, options.linear_light);
    Result result;
    const auto pyramid = pyramid_of(layer, options.pyramid, session, result.report);
    const std::vector<double> weights = region_weights(layer, options.region);
    session.progress.report(0.9, "Measuring the noise gain");
    const NoiseGains gains = noise_gains(pyramid->hierarchy(), pyramid->scheme());
    for (const Channels& c : all) {
        session.progress.report(0.92, "Denoising attributes");
        const Field after = denoised(c, *pyramid, gains, options, result.report);
        result.attributes.push_back(changed_attribute(layer, c, after, weights, result.report));
    }
    return result;
}

}  // namespace multires
