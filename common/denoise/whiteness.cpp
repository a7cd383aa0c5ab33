#include "denoise/whiteness.h"

#include "base/median.h"
#include "denoise/along_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace multires {
namespace {

/// Lengths of differences of the surface and of two samples of noise.
using DifferenceLengths = std::array<std::vector<double>, 3>;

DifferenceLengths third_differences(const Neighbours& near, const Positions& positions, const Array<Vec3>& normal) {
    constexpr int local_steps = 20;
    const AlongNormals surface(near, positions, normal, {});
    std::vector<double> h(3 * near.rows(), 0);
    for (Index v = 0; v < near.rows(); ++v)
        for (int c = 1; c < 3; ++c) h[3 * v + c] = gaussian(v, 100 + c);
    h = surface.linear_detail(surface.linear_detail(surface.detail(h)));
    std::vector<double> energy(h.size());
    for (std::size_t i = 0; i < h.size(); ++i) energy[i] = h[i] * h[i];
    average(near, energy, 3, local_steps);
    DifferenceLengths lengths;
    for (Index v = 0; v < near.rows(); ++v) {
        const double local = std::sqrt((energy[3 * v + 1] + energy[3 * v + 2]) / 2);
        if (near.rim[v] || !(local > 0)) continue;
        for (int c = 0; c < 3; ++c) lengths[c].push_back(std::abs(h[3 * v + c]) / local);
    }
    return lengths;
}

double ratio(std::vector<double>& lengths, double low, double high) {
    const double most = lower_quantile(lengths, high);
    return most > 0 ? lower_quantile(lengths, low) / most : 0;
}

}  // namespace

double whiteness(const Neighbours& near, const Positions& positions, const Array<Vec3>& normal) {
    DifferenceLengths lengths = third_differences(near, positions, normal);
    if (lengths[0].empty()) return 0;
    double least = 1;
    for (const auto& [low, high] : {std::pair{0.3, 0.9}, std::pair{0.5, 0.97}}) {
        const double expected = (ratio(lengths[1], low, high) + ratio(lengths[2], low, high)) / 2;
        if (expected > 0) least = std::min(least, ratio(lengths[0], low, high) / expected);
    }
    return least;
}

}  // namespace multires
