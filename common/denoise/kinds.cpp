#include "denoise/kinds.h"

#include "base/parallel.h"
#include "base/reduce.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// Averaging steps, and how many vertices of a regular mesh so many steps take the mean of.
constexpr int steps = 120;
constexpr double vertices_averaged = 6.2 * steps;
constexpr double alike = 6;        ///< vertices that differ together, for edges have two ends and blends are smooth
constexpr double clearly = 2;      ///< standard errors
constexpr double worth_it = 0.01;  ///< of the noise

/// 2 <b, v> + |u|^2 of an edge, where a blend that takes everything out is not sampled (see risks()).
double risk_of(const Blend& blend, std::size_t i, std::size_t j, double probe, double expected) {
    const std::vector<double>& r = blend.response;
    const double u = r[2 * i] - r[2 * j], v = r[2 * i + 1] - r[2 * j + 1];
    return 2 * (probe * v + blend.total * (probe * probe - expected)) + u * u;
}

}  // namespace

std::vector<double> risk_difference(const Neighbours& near, const Blend& first, const Blend& second,
                                    const std::vector<double>& deviation, const std::vector<double>& probe,
                                    const std::vector<std::uint8_t>& core) {
    std::vector<double> difference(core.size(), 0), noise(core.size(), 0);
    parallel_for(near.rows(), [&](Index vertex) {
        const std::size_t i = static_cast<std::size_t>(vertex);
        if (!core[i]) return;
        Mean risk, expected;
        for (Index e = near.offset[i]; e < near.offset[i + 1]; ++e) {
            const std::size_t j = static_cast<std::size_t>(near.vertex[e]);
            if (!core[j]) continue;
            const double square = deviation[i] * deviation[i] + deviation[j] * deviation[j], b = probe[i] - probe[j];
            risk.add(risk_of(first, i, j, b, square) - risk_of(second, i, j, b, square));
            expected.add(square);
        }
        difference[i] = risk.value();
        noise[i] = expected.value();
    });
    const double unit = chunked_fold<Mean>(core.size(), [&](Mean& mean, std::size_t i) {
                            if (core[i]) mean.add(noise[i]);
                        }).value();
    for (double& d : difference) d = unit > 0 ? d / unit : 0;
    return difference;
}

std::vector<double> shares_of_first(const Neighbours& near, const std::vector<double>& difference) {
    std::vector<double> moments(2 * difference.size());
    for (std::size_t i = 0; i < difference.size(); ++i) {
        moments[2 * i] = difference[i];
        moments[2 * i + 1] = difference[i] * difference[i];
    }
    average(near, moments, 2, steps);
    std::vector<double> share(difference.size());
    for (std::size_t i = 0; i < share.size(); ++i) {
        const double mean = moments[2 * i], variance = std::max(0.0, moments[2 * i + 1] - mean * mean);
        const double error = std::sqrt(variance * alike / vertices_averaged);
        share[i] = std::clamp(0.5 - mean / std::max(2 * clearly * error, 1e-12), 0.0, 1.0);
    }
    return share;
}

bool certainly_less(const std::vector<double>& difference, const std::vector<std::uint8_t>& core) {
    struct Moments {
        Mean first, second;
        Moments& operator+=(const Moments& o) {
            first += o.first, second += o.second;
            return *this;
        }
    };
    const auto m = chunked_fold<Moments>(core.size(), [&](Moments& part, std::size_t i) {
        if (!core[i]) return;
        part.first.add(difference[i]);
        part.second.add(difference[i] * difference[i]);
    });
    const double mean = m.first.value(), variance = std::max(0.0, m.second.value() - mean * mean);
    const double error = std::sqrt(variance * alike / std::max(1.0, m.first.weight));
    return -mean > std::max(worth_it, clearly * error);
}

}  // namespace multires
