#include "filters/attributes/attributes_band.h"

#include "mesh/validation.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// The band and the gain that an operation comes down to.
std::pair<Band, double> band_and_gain(const AttributeBandOptions& o) {
    Band band = o.band;
    switch (o.mode) {
    case BandMode::low_pass:
        if (!(o.cutoff > 0 && std::isfinite(o.cutoff))) throw InputError("cutoff must be a number, more than 0");
        band.finest = band.unit == Unit::vertices ? 1e300 : 0;
        band.coarsest = o.cutoff;
        return {band, 0};
    case BandMode::stop_band:
        return {band, 0};
    case BandMode::enhance:
        break;
    }
    if (!std::isfinite(o.gain)) throw InputError("gain must be a number");
    return {band, o.gain};
}

/// f + the sum over the limits of step (low pass of f - f), channels shifted so that constants stay exactly.
Field filter_calibrated(const Field& f, const Spline& spline, LowPassOrder order, const std::vector<Limit>& limits,
                        const Progress& progress) {
    if (limits.empty()) return f;
    const std::size_t width = static_cast<std::size_t>(f.width);
    Array<double> shifted(f.values.begin(), f.values.end()), low(shifted.size());
    for (std::size_t i = 0; i < shifted.size(); ++i) shifted[i] -= f.values[i % width];
    Field after = f;
    for (std::size_t l = 0; l < limits.size(); ++l) {
        const double share = 1 / static_cast<double>(limits.size()), begin = share * static_cast<double>(l);
        spline.low_pass({order, limits[l].wavelength}, ConstRows(shifted, f.width), Rows(low, f.width),
                        limits[l].parameter, progress.part(begin, begin + share));
        for (std::size_t i = 0; i < shifted.size(); ++i) after.values[i] += limits[l].step * (low[i] - shifted[i]);
    }
    return after;
}

}  // namespace

Result filter_attribute_bands(const Layer& layer, const AttributeBandOptions& options, Session& session) {
    require_usable(layer.mesh);  // before a default that could not be derived from the mesh is blamed
    const auto [band, gain] = band_and_gain(options);
    const std::vector<Channels> all = vertex_channels(layer, options.what, options.linear_light);
    Result result;
    if (options.calibration.method == BandMethod::spline) {
        const char* coarsest = options.mode == BandMode::low_pass ? "cutoff" : "coarsest";
        const std::vector<Limit> limits =
            limits_of(layer, band, gain, coarsest, options.pyramid, session, result.report);
        const auto spline = spline_of(layer, options.pyramid.features, session, result.report);
        const std::vector<double> weights = region_weights(layer, options.region);
        const Progress progress = session.progress.part(0.3, options.calibration.measure ? 0.6 : 1);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const double share = 1 / static_cast<double>(all.size()), begin = share * static_cast<double>(i);
            const Field after = filter_calibrated(all[i].field, *spline, options.calibration.order, limits,
                                                  progress.part(begin, begin + share));
            result.attributes.push_back(changed_attribute(layer, all[i], after, weights, result.report));
        }
        report_transmission(*spline, layer.mesh, options.calibration, limits, session.progress.part(0.6, 1),
                            result.report);
        return result;
    }
    const auto pyramid = pyramid_of(layer, options.pyramid, session, result.report);
    const std::vector<double> weights = region_weights(layer, options.region);
    const Bodies bodies(*pyramid, layer);
    const Gains gains = band_gains(bodies, band, box_diagonal(layer), gain);
    for (std::size_t i = 0; i < all.size(); ++i) {
        session.progress.report(0.9 + 0.1 * static_cast<double>(i) / static_cast<double>(all.size()),
                                "Filtering attributes");
        const Channels& c = all[i];
        const auto scaled = [&](const Coefficients& details) { return bodies.synthesise(details, gains); };
        const Field after = all_one(gains) ? c.field : through_pyramid(*pyramid, c.field, scaled);
        result.attributes.push_back(changed_attribute(layer, c, after, weights, result.report));
    }
    result.report.add("gains", gains[0]);
    return result;
}

}  // namespace multires
