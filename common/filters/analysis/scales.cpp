#include "filters/analysis/scales.h"

#include "base/parallel.h"
#include "base/reduce.h"
#include "filters/analysis/heights.h"
#include "filters/analysis/scale_space.h"
#include "filters/calibration.h"
#include "measure/vertex_normals.h"
#include "mesh/validation.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr double tolerance = 1e-2;  ///< of each band: see scales.h

void check(const ScaleOptions& o, double mean_edge) {
    require(o.bands >= 1 && o.bands <= most_scales, "bands must be 1 to " + std::to_string(most_scales));
    const double least = o.bands == 1 ? o.coarsest : o.finest;
    require_carried(least, o.bands == 1 ? "coarsest" : "finest", mean_edge);
    require(std::isfinite(o.coarsest), "coarsest must be a number");
    require(o.bands == 1 || o.coarsest > o.finest, "coarsest must be more than finest");
    const auto fits = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    };
    require(!o.name.empty() && std::all_of(o.name.begin(), o.name.end(), fits),
            "prefix must be letters, digits and _ only");
}

/// Which band stands out at each vertex.
class Strongest {
public:
    explicit Strongest(std::size_t n) : response_(n, -1), band_(n, 0) {}

    void take(int band, const std::vector<double>& detail, double rms) {
        parallel_for(static_cast<Index>(detail.size()), [&](Index i) {
            const double response = rms > 0 ? std::abs(detail[i]) / rms : 0;
            if (response > response_[i]) response_[i] = response, band_[i] = band;
        });
    }
    int band(std::size_t i) const { return band_[i]; }

private:
    std::vector<double> response_;
    std::vector<int> band_;
};

double rms_by_area(const std::vector<double>& values, const std::vector<double>& area) {
    return std::sqrt(chunked_fold<Mean>(values.size(), [&](Mean& m, std::size_t i) {
                         m += {area[i] * values[i] * values[i], area[i]};
                     }).value());
}

}  // namespace

std::vector<double> scale_limits(const ScaleOptions& o) {
    std::vector<double> limits;
    for (int b = 0; b < o.bands; ++b) {
        const double share = o.bands == 1 ? 1 : b / (o.bands - 1.0);
        limits.push_back(o.finest > 0 ? o.finest * std::pow(o.coarsest / o.finest, share) : o.coarsest);
    }
    limits.back() = o.coarsest;
    return limits;
}

Result scale_details(const Layer& layer, const ScaleOptions& options, Session& session) {
    Result result;
    const Mesh& mesh = layer.mesh;
    const auto spline = spline_of(layer, {}, session, result.report);
    check(options, spline->mean_edge());
    const std::vector<double> limits = scale_limits(options), area = vertex_areas(mesh);
    const std::size_t n = mesh.positions.size();
    std::vector<double> middle, rms;
    Strongest strongest(n);
    Positions before = mesh.positions;
    const auto take = [&](std::size_t b, const Positions& low) {
        const Array<Vec3> normal = vertex_normals(mesh.faces, low);
        std::vector<double> detail(n), height(options.values == ScaleValues::heights ? n : 0);
        parallel_for(static_cast<Index>(n), [&](Index i) {
            detail[i] = normal[i].dot(before[i] - low[i]);
            if (!height.empty()) height[i] = normal[i].dot(mesh.positions[i] - low[i]);
        });
        rms.push_back(rms_by_area(detail, area));
        strongest.take(static_cast<int>(b), detail, rms.back());
        result.attributes.push_back({AttributeKind::scalar, options.name + "_" + std::to_string(b + 1), 1,
                                     std::move(options.values == ScaleValues::bands ? detail : height)});
        before = low;
    };
    for_each_low_pass(*spline, mesh, limits, tolerance, session.progress.part(0.3, 0.97), take);
    const double ratio = limits.size() > 1 ? limits[1] / limits[0] : 2;
    for (const double limit : limits) middle.push_back(limit / std::sqrt(ratio));
    result.quality.emplace(n);
    for (std::size_t i = 0; i < n; ++i) (*result.quality)[i] = middle[strongest.band(i)];
    result.report.add("limits", limits, "mesh units");
    result.report.add("wavelengths", middle, "mesh units");
    result.report.add("rms_details", rms, "mesh units");
    return result;
}

}  // namespace multires
