#include "denoise/field_noise.h"

#include "base/parallel.h"
#include "denoise/local_noise.h"

#include <numeric>

namespace multires {
namespace {

constexpr double quiet = 0.15;  ///< quantile of the lengths that counts: low, because texture may be anywhere

NoiseByDifferences differences(const Neighbours& near, const std::vector<double>& weight,
                               const std::vector<double>& values) {
    std::vector<double> h(3 * values.size());
    parallel_for(near.rows(), [&](Index v) {
        h[3 * v] = values[v];
        for (int c = 1; c < 3; ++c) h[3 * v + c] = gaussian(v, 200 + c);
    });
    const std::vector<double> first = field_details(near, weight, h);
    return {near, first, field_details(near, weight, field_details(near, weight, first))};
}

double everywhere(const Neighbours& near, const NoiseByDifferences& noise) {
    std::vector<Index> all(near.rows());
    std::iota(all.begin(), all.end(), 0);
    return noise.at(std::move(all), quiet).noise;
}

}  // namespace

std::vector<double> field_details(const Neighbours& near, const std::vector<double>& weight,
                                  const std::vector<double>& h) {
    std::vector<double> out(h.size());
    parallel_for(near.rows(), [&](Index v) {
        for (int c = 0; c < 3; ++c) {
            double sum = 0;
            for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k)
                sum += weight[k] * (h[3 * v + c] - h[3 * static_cast<std::size_t>(near.vertex[k]) + c]);
            out[3 * v + c] = sum;
        }
    });
    return out;
}

double field_noise(const Neighbours& near, const std::vector<double>& weight, const std::vector<double>& values) {
    return everywhere(near, differences(near, weight, values));
}

std::vector<double> local_field_noise(const Neighbours& near, const std::vector<double>& weight,
                                      const Positions& positions, const std::vector<double>& values) {
    constexpr double least_variation = 0.22;  // the same noise everywhere has at most 0.17
    const NoiseByDifferences noise = differences(near, weight, values);
    const double same = everywhere(near, noise);
    const std::vector<double> varying = noise.varying(positions, same, least_variation);
    return varying.empty() ? std::vector<double>(values.size(), same) : varying;
}

}  // namespace multires
