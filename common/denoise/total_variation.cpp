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
    const bool two = values.size() > deviation.size() * width;
    const auto with_fields = [&](auto of_one, auto of_two) {
        return (this->*(two ? of_two : of_one))(values, deviation, strength);
    };
    using T = TotalVariation;
    if (width == 1) return with_fields(&T::denoised<1, 1>, &T::denoised<2, 1>);
    if (width == 2) return with_fields(&T::denoised<1, 2>, &T::denoised<2, 2>);
    if (width == 3) return with_fields(&T::denoised<1, 3>, &T::denoised<2, 3>);
    return with_fields(&T::denoised<1, 4>, &T::denoised<2, 4>);
}

template <int fields, int width>
std::vector<double> TotalVariation::denoised(const std::vector<double>& values, const std::vector<double>& deviation,
                                             double strength) const {
    constexpr int count = fields * width;
    const Index edges = static_cast<Index>(edge_.size());
    std::vector<double> x = values, pull(edge_.size() * count, 0), last = pull, limit(edge_.size()), step = limit;
    const auto square = [&](Index v) { return deviation[v] * deviation[v]; };
    parallel_for(edges, [&](Index e) {
        const auto [i, j] = edge_[e];
        const double s = (deviation[i] + deviation[j]) / 2, sum = square(i) * near_.size(i) + square(j) * near_.size(j);
        limit[e] = s > 0 ? strength / s : 0;
        step[e] = sum > 0 ? 1 / sum : 0;
    });
    const auto gather = [&](const std::vector<double>& p) {  // x = y - s^2 times the divergence
        parallel_for(near_.rows(), [&](Index v) {
            const double* from = values.data() + static_cast<std::size_t>(v) * count;
            std::array<double, count> sum;
            for (int c = 0; c < count; ++c) sum[c] = from[c];
            for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k) {
                const double side = v < near_.vertex[k] ? -square(v) : square(v);
                const double* pulled = p.data() + static_cast<std::size_t>(edge_of_[k]) * count;
                for (int c = 0; c < count; ++c) sum[c] += side * pulled[c];
            }
            double* to = x.data() + static_cast<std::size_t>(v) * count;
            for (int c = 0; c < count; ++c) to[c] = sum[c];
        });
    };
    double momentum = 1;
    for (int iteration = 0; iteration < iterations; ++iteration) {
        gather(pull);
        const double next = (1 + std::sqrt(1 + 4 * momentum * momentum)) / 2, ahead = (momentum - 1) / next;
        momentum = next;
        parallel_for(edges, [&](Index e) {
            const double* at_i = x.data() + static_cast<std::size_t>(edge_[e][0]) * count;
            const double* at_j = x.data() + static_cast<std::size_t>(edge_[e][1]) * count;
            double* pulled = pull.data() + static_cast<std::size_t>(e) * count;
            double* before = last.data() + static_cast<std::size_t>(e) * count;
            std::array<double, count> p;
            for (int c = 0; c < count; ++c) p[c] = pulled[c] + step[e] * (at_i[c] - at_j[c]);
            for (int field = 0; field < count; field += width) {
                double length = 0;
                for (int c = field; c < field + width; ++c) length += p[c] * p[c];
                const double scale = length > limit[e] * limit[e] ? limit[e] / std::sqrt(length) : 1;
                for (int c = field; c < field + width; ++c) {
                    const double now = scale * p[c];
                    pulled[c] = now + ahead * (now - before[c]);
                    before[c] = now;
                }
            }
        });
    }
    gather(last);
    return x;
}

}  // namespace multires
