#include "filters/analysis/relief.h"

#include "base/number.h"
#include "base/parallel.h"
#include "base/reduce.h"
#include "filters/analysis/heights.h"
#include "filters/analysis/powers.h"
#include "filters/analysis/scale_space.h"
#include "filters/calibration.h"
#include "measure/vertex_normals.h"
#include "mesh/specks.h"
#include "mesh/validation.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace multires {
namespace {

constexpr double choice_tolerance = 1e-2;  ///< of each band: a choice needs no more

/// Strokes pull a low pass with them that is not robust: that needs a longer limit to tell them from the rest.
constexpr double robust_share = 0.8;

/// Where the skewness of heights is largest: the mean of the cutoffs' logarithms by its eighth power, over those that
/// are skewed to the side of the most skewed. Nothing if none is.
std::optional<double> most_skewed(const Spline& spline, const Layer& layer, const Progress& progress) {
    const Mesh& mesh = layer.mesh;
    const double finest = 4 * spline.mean_edge(), coarsest = box_diagonal(layer) / 4;
    std::vector<double> cutoffs;
    for (int i = 0; i < 16 && finest * std::pow(2, 0.5 * i) <= coarsest; ++i)
        cutoffs.push_back(finest * std::pow(2, 0.5 * i));
    if (cutoffs.empty()) return std::nullopt;
    const auto large = without_specks(layer);
    const std::vector<double> area = vertex_areas(large ? large->layer.mesh : mesh),
                              rim = distance_from_rim(mesh, cutoffs.back() / 2);
    std::vector<double> skewness;
    for_each_low_pass(spline, mesh, cutoffs, choice_tolerance, progress, [&](std::size_t b, const Positions& low) {
        const Array<Vec3> normal = vertex_normals(mesh.faces, low);
        const Powers sums = chunked_fold<Powers>(mesh.positions.size(), [&](Powers& p, std::size_t i) {
            if (rim[i] >= cutoffs[b] / 2) p.add(area[i], normal[i].dot(mesh.positions[i] - low[i]));
        });
        skewness.push_back(sums.skewness());
    });
    const double most = *std::max_element(skewness.begin(), skewness.end(),
                                          [](double a, double b) { return std::abs(a) < std::abs(b); });
    if (most == 0) return std::nullopt;
    Mean mean;
    for (std::size_t b = 0; b < cutoffs.size(); ++b) {
        const double weight = std::pow(std::max(0.0, skewness[b] / most), 8);
        mean += {weight * std::log(cutoffs[b]), weight};
    }
    // To a sixteenth of an octave, so that the errors of loose solves leave no trace.
    return finest * std::exp2(std::round(16 * std::log2(std::exp(mean.value()) / finest)) / 16);
}

TextureBand band_of(const Spline& spline, const Layer& layer, const ReliefOptions& o, const Progress& progress,
                    Report& report) {
    TextureBand band;
    band.order = o.order, band.robust = o.robust;
    if (o.coarsest) {
        band.finest = {o.finest, "finest"}, band.coarsest = {*o.coarsest, "coarsest"};
        return band;
    }
    const double shortest = 2 * spline.mean_edge();
    const double skewed = most_skewed(spline, layer, progress).value_or(4 * shortest);
    const double coarsest = std::max(o.robust ? robust_share * skewed : skewed, shortest), finest = coarsest / 2;
    band.coarsest = {coarsest, "coarsest"};
    // A fine limit that is just that of the mesh (by rounding, or not) makes no difference: none.
    band.finest = {o.finest > 0 ? o.finest : finest > 1.001 * shortest ? finest : 0, "finest"};
    report.say("Band chosen: waves from " + number(band.finest.wavelength, 3) + " to " + number(coarsest, 3) + ".");
    return band;
}

/// Blue, grey, red; linear in between.
std::array<double, 3> diverging(double t) {
    constexpr std::array<double, 3> low{59, 76, 192}, level{221, 221, 221}, high{180, 4, 38};
    const std::array<double, 3>& end = t < 0 ? low : high;
    const double share = std::min(std::abs(t), 1.0);
    std::array<double, 3> rgb;
    for (int k = 0; k < 3; ++k) rgb[k] = std::round(level[k] + share * (end[k] - level[k]));
    return rgb;
}

Attribute colors_of(const std::vector<double>& height) {
    std::vector<double> sizes(height.size());
    for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = std::abs(height[i]);
    const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() - 1 - sizes.size() / 100);
    std::nth_element(sizes.begin(), at, sizes.end());
    const double full = *at > 0 ? *at : 1;
    Attribute color{AttributeKind::color, "", 4, {}};
    color.values.reserve(4 * height.size());
    for (const double h : height) {
        const std::array<double, 3> rgb = diverging(h / full);
        color.values.insert(color.values.end(), {rgb[0], rgb[1], rgb[2], 255});
    }
    return color;
}

}  // namespace

Result relief(const Layer& layer, const ReliefOptions& options, Session& session) {
    require_usable(layer.mesh);
    require(std::isfinite(options.finest) && options.finest >= 0, "finest must be a number, 0 or more");
    require(!options.coarsest || *options.coarsest > options.finest, "coarsest must be more than finest");
    Result result;
    const auto spline = spline_of(layer, {}, session, result.report);
    const TextureBand band = band_of(*spline, layer, options, session.progress.part(0.3, 0.5), result.report);
    require(band.coarsest.wavelength > band.finest.wavelength,
            "finest must be less than the coarse limit that was chosen; give coarsest, too");
    Heights heights = heights_over_low_pass(*spline, layer.mesh, band, session.progress.part(0.5, 0.95));
    session.progress.report(0.95, "Adding up");
    const std::vector<double> area = vertex_areas(layer.mesh);
    const Powers sums = chunked_fold<Powers>(heights.height.size(),
                                             [&](Powers& p, std::size_t i) { p.add(area[i], heights.height[i]); });
    const auto [lowest, highest] = std::minmax_element(heights.height.begin(), heights.height.end());
    result.report.add("finest", band.finest.wavelength, "mesh units");
    result.report.add("coarsest", band.coarsest.wavelength, "mesh units");
    result.report.add("lowest", *lowest, "mesh units");
    result.report.add("highest", *highest, "mesh units");
    result.report.add("rms_height", sums.weight > 0 ? std::sqrt(sums.second / sums.weight) : 0, "mesh units");
    result.report.add("skewness", sums.skewness());
    if (options.color) result.attributes.push_back(colors_of(heights.height));
    result.quality = std::move(heights.height);
    return result;
}

}  // namespace multires
