#include "denoise/white_share.h"

#include "base/median.h"
#include "denoise/energies.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// Energies of what a blend takes out by those of its response to the probe.
struct Ratio {
    std::array<double, 2> quiet{};  ///< what a tenth and half of the surface stay below
    double response = 0;            ///< sum of the latter
};

Ratio ratio_of(const std::vector<double>& squares, const Neighbours& near, const std::vector<std::uint8_t>& core) {
    std::array<std::vector<double>, 2> energy;
    Ratio out;
    for (Index v = 0; v < near.rows(); ++v) {
        if (!core[v] || near.rim[v]) continue;
        for (int c = 0; c < 2; ++c) energy[c].push_back(squares[3 * static_cast<std::size_t>(v) + c]);
        out.response += energy[1].back();
    }
    if (energy[0].empty()) return out;
    constexpr std::array<double, 2> share = {0.1, 0.5};
    for (std::size_t q = 0; q < share.size(); ++q) {
        const double response = lower_quantile(energy[1], share[q]);
        out.quiet[q] = response > 0 ? lower_quantile(energy[0], share[q]) / response : 0;
    }
    return out;
}

}  // namespace

double white_share(double lower, double higher, double falls) {
    constexpr double roughest = 1.5;  // p
    const double rough = std::pow(falls, roughest / 2);
    if (!(lower > 0) || !(rough < 1)) return 0;
    return std::max(0.0, 1 - std::max(0.0, 1 - higher / lower) / (1 - rough));
}

double error_of_white_share(Index vertices) { return vertices > 0 ? 2 / std::sqrt(static_cast<double>(vertices)) : 1; }

double white_share_removed(const std::function<std::vector<double>(const std::vector<double>&)>& detail,
                           const Neighbours& near, std::vector<double> h, const std::vector<std::uint8_t>& core) {
    std::array<Ratio, 4> order;
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (k > 0) h = detail(h);
        order[k] = ratio_of(local_squares(near, h), near, core);
    }
    if (!(order[0].response > 0 && order[3].response > 0)) return 0;
    const double falls = order[2].response / order[3].response * order[1].response / order[0].response;
    const double most = std::max(white_share(order[1].quiet[0], order[3].quiet[0], falls),
                                 white_share(order[1].quiet[1], order[3].quiet[1], falls));
    return std::max(0.0, most - error_of_white_share(near.rows()));
}

double white_share_removed(const AlongNormals& surface, const Neighbours& near, const std::vector<Response>& candidates,
                           const Eigen::VectorXd& weights, const std::vector<std::uint8_t>& core) {
    std::vector<double> h(3 * core.size(), 0);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const double weight = weights[static_cast<Eigen::Index>(k)];
        for (std::size_t i = 0; weight > 0 && i < core.size(); ++i)
            for (int c = 0; c < 2; ++c) h[3 * i + c] += weight * candidates[k][2 * i + c];
    }
    return white_share_removed([&](const std::vector<double>& x) { return surface.linear_detail(x); }, near,
                               std::move(h), core);
}

}  // namespace multires
