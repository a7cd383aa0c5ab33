#include "denoise/value_steps.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr std::size_t least_levels = 5;
constexpr double most_levels = 0.1;  ///< of the vertices
constexpr double most_jumps = 0.1;   ///< share of the edges between levels that skip one
constexpr double least_plain = 0.2;  ///< share of the edges that stay on a level

/// The values there are, ascending; empty if there are too many or too few to be levels.
std::vector<double> levels_of(std::vector<double> values) {
    const double count = static_cast<double>(values.size());
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    if (values.size() < least_levels || static_cast<double>(values.size()) > most_levels * count) values.clear();
    return values;
}

/// Spacing of the levels if they are evenly spaced, but for gaps; otherwise 0.
double spacing(const std::vector<double>& levels) {
    double least = levels.back() - levels.front();
    for (std::size_t i = 1; i < levels.size(); ++i) least = std::min(least, levels[i] - levels[i - 1]);
    const double step = (levels.back() - levels.front()) / std::round((levels.back() - levels.front()) / least);
    constexpr double tolerance = 0.01;
    for (const double x : levels) {
        const double at = (x - levels.front()) / step;
        if (std::abs(at - std::round(at)) > tolerance) return 0;
    }
    return step;
}

}  // namespace

double rounding_step(const Neighbours& near, const std::vector<double>& values) {
    const std::vector<double> levels = levels_of(values);
    if (levels.empty()) return 0;
    const double step = spacing(levels);
    if (!(step > 0)) return 0;
    double plain = 0, single = 0, jumps = 0;
    for (Index v = 0; v < near.rows(); ++v)
        for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) {
            const double apart = std::abs(values[v] - values[near.vertex[k]]) / step;
            ++(apart < 0.5 ? plain : apart < 1.5 ? single : jumps);
        }
    const bool contours = plain >= least_plain * (plain + single + jumps) && jumps <= most_jumps * (single + jumps);
    return contours && single > 0 ? step : 0;
}

std::vector<double> within_steps(const Neighbours& near, const std::vector<double>& values, double step) {
    constexpr int iterations = 30;
    std::vector<double> x = values, next = values;
    const auto step_towards_mean = [&](double factor) {
        parallel_for(near.rows(), [&](Index v) {
            double sum = 0;
            for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) sum += x[near.vertex[k]];
            next[v] = near.size(v) > 0 ? x[v] + factor * (sum / near.size(v) - x[v]) : x[v];
        });
        x.swap(next);
    };
    for (int i = 0; i < iterations; ++i) {
        step_towards_mean(0.5);
        step_towards_mean(-0.5);
        parallel_for(near.rows(),
                     [&](Index v) { x[v] = std::clamp(x[v], values[v] - step / 2, values[v] + step / 2); });
    }
    return x;
}

}  // namespace multires
