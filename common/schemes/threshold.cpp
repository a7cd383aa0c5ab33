#include "schemes/threshold.h"

#include "base/median.h"

#include <cstdint>
#include <utility>

namespace multires {
namespace {

/// Root mean square of all components.
double rms(const Field& f) {
    double sum = 0;
    for (const double v : f.values) sum += v * v;
    return f.values.empty() ? 0 : std::sqrt(sum / static_cast<double>(f.values.size()));
}

/// A standard normal number from an index: sum of twelve uniform ones (splitmix64), good to three deviations.
double normal_number(std::uint64_t index) {
    double sum = -6;
    for (std::uint64_t k = 0; k < 12; ++k) {
        std::uint64_t z = (index * 12 + k + 1) * 0x9e3779b97f4a7c15u;
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
        z = (z ^ z >> 27) * 0x94d049bb133111ebu;
        sum += static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
    }
    return sum;
}

}  // namespace

NoiseGains noise_gains(const Hierarchy& hierarchy, const Scheme& scheme) {
    Field noise(hierarchy.vertices(), 1);
    noise.has_positions = false;
    for (Index i = 0; i < noise.rows(); ++i) noise.values[i] = normal_number(static_cast<std::uint64_t>(i));
    const Coefficients c = scheme.analyse(std::move(noise));
    NoiseGains gains;
    for (const std::vector<Subband>& level : c.level) {
        gains.emplace_back();
        for (const Subband& band : level) gains.back().push_back(rms(band.values));
    }
    return gains;
}

double deviation_by_median(std::vector<double>& values) {
    if (values.empty()) return 0;
    for (double& v : values) v = std::abs(v);
    return upper_median(values) / 0.6745;
}

}  // namespace multires
