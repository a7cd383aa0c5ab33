#include "denoise/field_noise.h"

#include "base/median.h"
#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace multires {
namespace {

constexpr double quiet = 0.15;          ///< quantile of the lengths that counts
constexpr double share_of_shape = 0.3;  ///< of the first differences that passes for noise in the third ones

/// Detail of all three channels: less the weighted mean of the neighbours.
std::vector<double> detail(const Neighbours& near, const std::vector<double>& weight, const std::vector<double>& h) {
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

/// Lengths of details of the values and of two samples of noise, over what the mesh makes of noise locally.
class ValueLengths {
public:
    ValueLengths(const Neighbours& near, const std::vector<double>& h) {
        constexpr int local_steps = 10;
        std::vector<double> energy(h.size());
        for (std::size_t i = 0; i < h.size(); ++i) energy[i] = h[i] * h[i];
        average(near, energy, 3, local_steps);
        for (const bool with_rim : {false, true}) {
            for (Index v = 0; v < near.rows(); ++v) {
                const double local = std::sqrt((energy[3 * v + 1] + energy[3 * v + 2]) / 2);
                if ((near.rim[v] && !with_rim) || !(local > 0)) continue;
                for (int c = 0; c < 3; ++c) all_[c].push_back(std::abs(h[3 * v + c]) / local);
            }
            if (!all_[0].empty()) break;  // all vertices lie on a rim
        }
    }

    bool empty() const { return all_[0].empty(); }
    /// A quantile of the values over that of the noise.
    double ratio(double share) {
        const double noise = (quantile(1, share) + quantile(2, share)) / 2;
        return noise > 0 ? quantile(0, share) / noise : 0;
    }

private:
    double quantile(int channel, double share) { return lower_quantile(all_[channel], share); }

    std::array<std::vector<double>, 3> all_;
};

}  // namespace

double field_noise(const Neighbours& near, const std::vector<double>& weight, const std::vector<double>& values) {
    std::vector<double> h(3 * values.size());
    for (Index v = 0; v < near.rows(); ++v) {
        h[3 * v] = values[v];
        for (int c = 1; c < 3; ++c) h[3 * v + c] = gaussian(v, 200 + c);
    }
    h = detail(near, weight, h);
    ValueLengths first(near, h);
    if (first.empty()) return 0;
    h = detail(near, weight, detail(near, weight, h));
    ValueLengths third(near, h);
    // A step spoils the third differences of more vertices than it does the first.
    const double low = std::min(first.ratio(quiet), third.ratio(quiet));
    if (!(low > 0)) return 0;
    const double shape = std::max(0.0, std::pow(first.ratio(quiet), 2) - low * low);
    const double body = third.ratio(0.7) / third.ratio(quiet);
    const double believed = std::clamp((1.35 - body) / 0.2, 0.0, 1.0);
    return believed * std::sqrt(std::max(0.0, low * low - share_of_shape * share_of_shape * shape));
}

}  // namespace multires
