#include "denoise/noise_classes.h"

#include "base/median.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr double apart = 1.25;  ///< deviations of neighbouring classes are at least so many times as large

double logarithm(double deviation) { return std::log(std::max(deviation, 1e-300)); }

}  // namespace

NoiseClasses::NoiseClasses(std::vector<double> deviation) {
    for (const double share : {0.1, 0.5, 0.9}) {
        const double at = deviation.empty() ? 0 : logarithm(lower_quantile(deviation, share));
        if (at_.empty() || at > at_.back() + std::log(apart)) at_.push_back(at);
    }
}

std::array<double, 3> NoiseClasses::shares(double deviation) const {
    std::array<double, 3> out{};
    const double x = logarithm(deviation);
    std::size_t above = 0;
    while (above < at_.size() && at_[above] <= x) ++above;
    if (above == 0) {
        out.front() = 1;
    } else if (above == at_.size()) {
        out[above - 1] = 1;
    } else {
        const double t = (x - at_[above - 1]) / (at_[above] - at_[above - 1]);
        out[above - 1] = 1 - t;
        out[above] = t;
    }
    return out;
}

}  // namespace multires
