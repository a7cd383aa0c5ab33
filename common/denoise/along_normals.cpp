#include "denoise/along_normals.h"

#include "base/parallel.h"

namespace multires {

AlongNormals::AlongNormals(const Neighbours& near, const Positions& p, const Array<Vec3>& normal,
                           const std::vector<double>& weight)
    : near_(near), constant_(near.rows()), weight_(near.vertex.size()) {
    parallel_for(near.rows(), [&](Index v) {
        Vec3 sum = Vec3::Zero();
        for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) {
            const Index j = near.vertex[k];
            const double w = weight.empty() ? 1.0 / near.size(v) : weight[k];
            sum += w * (p[j] - p[v]);
            weight_[k] = w * normal[v].dot(normal[j]);
        }
        constant_[v] = normal[v].dot(sum);
    });
}

std::vector<double> AlongNormals::detail(const std::vector<double>& h) const { return detail(h, 1); }
std::vector<double> AlongNormals::linear_detail(const std::vector<double>& h) const { return detail(h, 0); }

std::vector<double> AlongNormals::detail(const std::vector<double>& h, double constant) const {
    std::vector<double> out(h.size());
    parallel_for(near_.rows(), [&](Index v) {
        const std::array<double, 3> sum = neighbours_of<3>(h, v);
        const bool alone = near_.size(v) == 0;
        for (int c = 0; c < 3; ++c)
            out[3 * v + c] = alone ? 0 : h[3 * v + c] - sum[c] - (c == 0 ? constant * constant_[v] : 0);
    });
    return out;
}

void AlongNormals::smooth(std::vector<double>& h, int steps) const {
    const std::size_t count = constant_.size();
    if (h.size() == count) return smooth_channels<1>(h, steps);
    if (h.size() == 2 * count) return smooth_channels<2>(h, steps);
    smooth_channels<3>(h, steps);
}

template <int width>
void AlongNormals::smooth_channels(std::vector<double>& h, int steps) const {
    std::vector<double> next(h.size());
    for (int step = 0; step < 2 * steps; ++step) {
        const double factor = step % 2 == 0 ? 0.5 : -0.5;
        parallel_for(near_.rows(), [&](Index v) {
            std::array<double, width> sum = neighbours_of<width>(h, v);
            sum[0] += constant_[v];
            const double f = near_.size(v) > 0 ? factor : 0;
            const std::size_t i = static_cast<std::size_t>(v) * width;
            for (int c = 0; c < width; ++c) next[i + c] = h[i + c] + f * (sum[c] - h[i + c]);
        });
        h.swap(next);
    }
}

template <int width>
std::array<double, width> AlongNormals::neighbours_of(const std::vector<double>& h, Index v) const {
    std::array<double, width> sum{};
    for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k) {
        const double* from = h.data() + width * static_cast<std::size_t>(near_.vertex[k]);
        for (int c = 0; c < width; ++c) sum[c] += weight_[k] * from[c];
    }
    return sum;
}

}  // namespace multires
