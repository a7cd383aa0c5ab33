#include "filters/analysis/robust_heights.h"

#include "base/median.h"
#include "base/parallel.h"
#include "base/reduce.h"
#include "filters/analysis/powers.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr int rounds = 4;
/// A median of absolute differences to three standard deviations of a normal distribution.
constexpr double reach = 3 * 1.4826;
constexpr double least_weight = 0.02;
/// Where nearly everything around is cut, the weights' low pass is small: then the base nears that of plain heights.
constexpr double least_sum = 0.05;

/// Tukey's biweight on one side: 1 up to the median.
std::vector<double> weights_of(const std::vector<double>& depth) {
    std::vector<double> sorted = depth;
    const double middle = upper_median(sorted);
    for (double& d : sorted) d = std::abs(d - middle);
    const double far = reach * upper_median(sorted);
    std::vector<double> weight(depth.size(), 1);
    if (!(far > 0)) return weight;
    parallel_for(static_cast<Index>(depth.size()), [&](Index i) {
        const double t = std::clamp((depth[i] - middle) / far, 0.0, 1.0), u = 1 - t * t;
        weight[i] = least_weight + (1 - least_weight) * u * u;
    });
    return weight;
}

}  // namespace

double skewness_of(const std::vector<double>& values, const std::vector<double>& weight) {
    return chunked_fold<Powers>(values.size(), [&](Powers& p, std::size_t i) { p.add(weight[i], values[i]); })
        .skewness();
}

std::vector<double> robust_base(const Spline& spline, const std::vector<double>& height,
                                const std::vector<double>& area, LowPassOrder order, double coarsest,
                                const Progress& progress) {
    const Index n = static_cast<Index>(height.size());
    const double finest = std::max(2 * spline.mean_edge(), 0.3 * coarsest);
    Array<double> raw(height.begin(), height.end()), clear(n);
    spline.low_pass({order, finest}, ConstRows(raw, 1), Rows(clear, 1), "coarsest", progress.part(0, 0.2));
    const std::vector<double> seen(clear.begin(), clear.end());
    const double side = skewness_of(seen, area) < 0 ? -1 : 1;
    std::vector<double> base(n, 0), depth(n);
    Array<double> weighted(2 * static_cast<std::size_t>(n)), low(weighted.size());
    for (int round = 0; round < rounds; ++round) {
        for (Index i = 0; i < n; ++i) depth[i] = side * (seen[i] - base[i]);
        const std::vector<double> weight = weights_of(depth);
        for (Index i = 0; i < n; ++i) weighted[2 * i] = weight[i] * height[i], weighted[2 * i + 1] = weight[i];
        spline.low_pass({order, coarsest}, ConstRows(weighted, 2), Rows(low, 2), "coarsest",
                        progress.part(0.2 + 0.8 * round / rounds, 0.2 + 0.8 * (round + 1) / rounds));
        for (Index i = 0; i < n; ++i) base[i] = low[2 * i] / std::max(least_sum, low[2 * i + 1]);
    }
    return base;
}

}  // namespace multires
