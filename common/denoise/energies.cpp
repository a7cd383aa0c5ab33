#include "denoise/energies.h"

#include "base/median.h"
#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace multires {
namespace {

constexpr int energy_steps = 6;   ///< averaging that makes an energy local
constexpr int smooth_steps = 20;  ///< more of it for what white noise leaves: a property of the mesh alone
constexpr std::size_t bins = 10;

double quantile_of(std::vector<double> values, double share) {
    return values.empty() ? 0 : lower_quantile(values, share);
}

double mean_of(const std::vector<double>& values) {
    return values.empty() ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Moments of the means of tenths.
struct Moments {
    double x = 0, y = 0;    ///< means
    double xx = 0, xy = 0;  ///< variance and covariance
};

/// @param relative  weights that make the error of each tenth's y a share of it
Moments moments(const std::vector<double>& x, const std::vector<double>& y, bool relative) {
    std::vector<std::size_t> order(x.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return x[a] != x[b] ? x[a] < x[b] : a < b; });
    Moments m;
    double weights = 0;
    for (std::size_t bin = 0; bin < bins; ++bin) {
        const std::size_t begin = bin * x.size() / bins, end = (bin + 1) * x.size() / bins;
        if (begin == end) continue;
        double mean_x = 0, mean_y = 0;
        for (std::size_t k = begin; k < end; ++k) {
            mean_x += x[order[k]] / static_cast<double>(end - begin);
            mean_y += y[order[k]] / static_cast<double>(end - begin);
        }
        if (!(mean_y > 0)) return {};
        const double weight = relative ? 1 / (mean_y * mean_y) : 1;
        weights += weight;
        m.x += weight * mean_x;
        m.y += weight * mean_y;
        m.xx += weight * mean_x * mean_x;
        m.xy += weight * mean_x * mean_y;
    }
    if (!(weights > 0)) return {};
    m.x /= weights;
    m.y /= weights;
    m.xx = m.xx / weights - m.x * m.x;
    m.xy = m.xy / weights - m.x * m.y;
    return m;
}

}  // namespace

double Energies::quantile(double share) const {
    std::array<double, 3> of{};
    parallel_for(
        3, [&](Index k) { of[k] = quantile_of(k < 2 ? noise[k] : field, share); }, 1);
    const double expected = of[0] + of[1];
    return expected > 0 ? 2 * of[2] / expected : 0;
}

double Energies::mean() const {
    const double expected = mean_of(noise[0]) + mean_of(noise[1]);
    return expected > 0 ? 2 * mean_of(field) / expected : 0;
}

std::vector<double> local_squares(const Neighbours& near, const std::vector<double>& detail) {
    std::vector<double> energy(detail.size());
    for (std::size_t i = 0; i < detail.size(); ++i) energy[i] = detail[i] * detail[i];
    average(near, energy, 3, energy_steps);
    return energy;
}

Energies local_energies(const Neighbours& near, const std::vector<double>& energy, const std::vector<Index>& inner) {
    std::vector<double> expected(near.rows());
    for (Index v = 0; v < near.rows(); ++v) expected[v] = (energy[3 * v + 1] + energy[3 * v + 2]) / 2;
    average(near, expected, 1, smooth_steps);
    Energies e;
    e.field.resize(inner.size());
    for (auto& sample : e.noise) sample.resize(inner.size());
    for (std::size_t i = 0; i < inner.size(); ++i) {
        const Index v = inner[i];
        const double scale = expected[v] > 0 ? 1 / expected[v] : 0;
        e.field[i] = scale * energy[3 * v];
        e.noise[0][i] = scale * energy[3 * v + 1];
        e.noise[1][i] = scale * energy[3 * v + 2];
    }
    return e;
}

double peakedness(const std::vector<double>& detail, const std::vector<double>& energy,
                  const std::vector<Index>& inner) {
    return peakedness(detail, energy, inner, {}, 1);
}

double peakedness(const std::vector<double>& detail, const std::vector<double>& energy, const std::vector<Index>& inner,
                  const Energies& local, double share) {
    const std::array<const std::vector<double>*, 3> of_channel = {&local.field, &local.noise[0], &local.noise[1]};
    std::array<double, 3> peak{};
    for (std::size_t c = 0; c < peak.size(); ++c) {
        const std::vector<double>& energies = *of_channel[c];
        const double most = quantile_of(energies, share);
        double size = 0, square = 0, count = 0;
        for (std::size_t i = 0; i < inner.size(); ++i) {
            const std::size_t at = 3 * static_cast<std::size_t>(inner[i]) + c;
            if (!(energy[at] > 0) || (share < 1 && energies[i] > most)) continue;
            const double x = detail[at] * detail[at] / energy[at];
            size += std::sqrt(x);
            square += x;
            ++count;
        }
        if (size > 0) peak[c] = count * square / (size * size);
    }
    const double expected = (peak[1] + peak[2]) / 2;
    return expected > 0 ? peak[0] / expected : 0;
}

double without_bends(const Energies& energy, const Energies& bends) {
    Moments field;
    std::array<Moments, 2> noise;
    parallel_for(
        3,
        [&](Index k) {
            if (k == 2)
                field = moments(bends.field, energy.field, true);
            else
                noise[k] = moments(bends.noise[k], energy.noise[k], false);
        },
        1);
    const double mean_x = (noise[0].x + noise[1].x) / 2, mean_y = (noise[0].y + noise[1].y) / 2;
    const double chance_xx = (noise[0].xx + noise[1].xx) / 2, chance_xy = (noise[0].xy + noise[1].xy) / 2;
    if (!(mean_y > 0)) return 0;
    // What chance contributes goes with the result: a few steps settle it.
    double found = field.y / mean_y;
    for (int step = 0; step < 50; ++step) {
        const double xx = field.xx - found * found * chance_xx, xy = field.xy - found * found * chance_xy;
        const double beyond_chance = field.xx > 0 ? std::clamp((xx / field.xx - 0.5) / 0.3, 0.0, 1.0) : 0;
        const double share = xx > 0 && xy > 0 ? beyond_chance * std::min(0.9, xy / xx) : 0;
        const double rest = mean_y - share * mean_x;
        found = (found + (rest > 0 ? std::max(0.0, (field.y - share * field.x) / rest) : 0)) / 2;
    }
    return found;
}

}  // namespace multires
