#include "denoise/total_variation.h"

#include "base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace multires {
namespace {

constexpr int iterations = 40;

}  // namespace

TotalVariation::TotalVariation(const Neighbours& near) : near_(near), edge_of_(near.vertex.size()) {
    edge_.reserve(near.vertex.size() / 2);
    for (Index v = 0; v < near.rows(); ++v)
        for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) {
            const Index w = near.vertex[k];
            if (v < w) {
                edge_of_[k] = static_cast<Index>(edge_.size());
                edge_.push_back({v, w});
            } else {
                const auto row = near.vertex.begin();
                const auto back = std::lower_bound(row + near.offset[w], row + near.offset[w + 1], v);
                edge_of_[k] = edge_of_[back - row];
            }
        }
}

std::vector<double> TotalVariation::denoised(const std::vector<double>& values, int width,
                                             const std::vector<double>& deviation, double strength) const {
    const Index edges = static_cast<Index>(edge_.size());
    std::vector<double> x = values, pull(edge_.size() * width, 0), last = pull, limit(edge_.size()), step = limit;
    const auto square = [&](Index v) { return deviation[v] * deviation[v]; };
    parallel_for(edges, [&](Index e) {
        const auto [i, j] = edge_[e];
        const double s = (deviation[i] + deviation[j]) / 2, sum = square(i) * near_.size(i) + square(j) * near_.size(j);
        limit[e] = s > 0 ? strength / s : 0;
        step[e] = sum > 0 ? 1 / sum : 0;
    });
    const auto gather = [&](const std::vector<double>& p) {  // x = y - s^2 times the divergence
        parallel_for(near_.rows(), [&](Index v) {
            double* to = x.data() + static_cast<std::size_t>(v) * width;
            const double* from = values.data() + static_cast<std::size_t>(v) * width;
            for (int c = 0; c < width; ++c) to[c] = from[c];
            for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k) {
                const double side = v < near_.vertex[k] ? -square(v) : square(v);
                const double* pulled = p.data() + static_cast<std::size_t>(edge_of_[k]) * width;
                for (int c = 0; c < width; ++c) to[c] += side * pulled[c];
            }
        });
    };
    double momentum = 1;
    for (int iteration = 0; iteration < iterations; ++iteration) {
        gather(pull);
        const double next = (1 + std::sqrt(1 + 4 * momentum * momentum)) / 2, ahead = (momentum - 1) / next;
        momentum = next;
        parallel_for(edges, [&](Index e) {
            const auto [i, j] = edge_[e];
            std::array<double, 4> p{};
            double length = 0;
            for (int c = 0; c < width; ++c) {
                p[c] =
                    pull[static_cast<std::size_t>(e) * width + c] +
                    step[e] * (x[static_cast<std::size_t>(i) * width + c] - x[static_cast<std::size_t>(j) * width + c]);
                length += p[c] * p[c];
            }
            const double scale = length > limit[e] * limit[e] ? limit[e] / std::sqrt(length) : 1;
            for (int c = 0; c < width; ++c) {
                const std::size_t at = static_cast<std::size_t>(e) * width + c;
                const double now = scale * p[c];
                pull[at] = now + ahead * (now - last[at]);
                last[at] = now;
            }
        });
    }
    gather(last);
    return x;
}

}  // namespace multires
