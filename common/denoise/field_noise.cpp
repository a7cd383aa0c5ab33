#include "denoise/field_noise.h"

#include "base/median.h"
#include "base/parallel.h"
#include "mesh/cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace multires {
namespace {

/// Quantiles of the lengths that count: low, because texture may be anywhere, but in cells, where that would scatter.
constexpr double quiet_everywhere = 0.15, quiet_in_cells = 0.3;
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
    ValueLengths(const Neighbours& near, const std::vector<double>& h) : length_(h.size(), 0) {
        constexpr int local_steps = 10;
        std::vector<double> energy(h.size());
        for (std::size_t i = 0; i < h.size(); ++i) energy[i] = h[i] * h[i];
        average(near, energy, 3, local_steps);
        parallel_for(near.rows(), [&](Index v) {
            const double local = std::sqrt((energy[3 * v + 1] + energy[3 * v + 2]) / 2);
            for (int c = 0; c < 3; ++c) length_[3 * v + c] = local > 0 ? std::abs(h[3 * v + c]) / local : -1;
        });
    }

    double length(Index v, int channel) const { return length_[3 * static_cast<std::size_t>(v) + channel]; }
    bool counts(Index v) const { return length_[3 * static_cast<std::size_t>(v)] >= 0; }
    /// A quantile of the values over that of the noise.
    double ratio(const std::vector<Index>& vertices, double share) const {
        const double noise = (quantile(vertices, 1, share) + quantile(vertices, 2, share)) / 2;
        return noise > 0 ? quantile(vertices, 0, share) / noise : 0;
    }

private:
    double quantile(const std::vector<Index>& vertices, int channel, double share) const {
        std::vector<double> all;
        all.reserve(vertices.size());
        for (const Index v : vertices) all.push_back(length_[3 * static_cast<std::size_t>(v) + channel]);
        return lower_quantile(all, share);
    }

    std::vector<double> length_;
};

/// What some vertices tell.
struct Found {
    double noise = 0;
    bool white = false;  ///< first differences are about as large as third ones
};

class FieldNoise {
public:
    FieldNoise(const Neighbours& near, const std::vector<double>& weight, const std::vector<double>& values)
        : near_(near), first_(near, first_details(near, weight, values)),
          third_(near, detail(near, weight, detail(near, weight, first_details(near, weight, values)))) {}

    /// @param quiet  quantile of the lengths that counts
    Found at(std::vector<Index> vertices, double quiet) const {
        const auto usable = [&](Index v, bool with_rim) {
            return (with_rim || !near_.rim[v]) && first_.counts(v) && third_.counts(v);
        };
        const bool with_rim = std::none_of(vertices.begin(), vertices.end(), [&](Index v) { return usable(v, false); });
        vertices.erase(std::remove_if(vertices.begin(), vertices.end(), [&](Index v) { return !usable(v, with_rim); }),
                       vertices.end());
        if (vertices.empty()) return {};
        // A step spoils the third differences of more vertices than it does the first.
        const double first = first_.ratio(vertices, quiet), third = third_.ratio(vertices, quiet);
        const double low = std::min(first, third);
        if (!(low > 0)) return {};
        const double shape = std::max(0.0, first * first - low * low);
        const double body = third_.ratio(vertices, 0.7) / third;
        const double believed = std::clamp((1.35 - body) / 0.2, 0.0, 1.0);
        constexpr double most_of_white = 1.2;
        return {believed * std::sqrt(std::max(0.0, low * low - share_of_shape * share_of_shape * shape)),
                first < most_of_white * third};
    }

    /// Deviations that follow the third differences around each vertex, where they are not many times as large.
    /// @param deviation  #V: about what they are
    /// @param follows    #V: 0 where it is not known to be noise, which stays
    std::vector<double> refined(const std::vector<double>& deviation, const std::vector<std::uint8_t>& follows) const {
        constexpr int steps = 60;
        constexpr double most = 2.5;
        std::vector<double> own(deviation.size(), 0), noise = own, out = deviation;
        parallel_for(near_.rows(), [&](Index v) {
            if (!third_.counts(v)) return;
            noise[v] = (std::min(third_.length(v, 1), most) + std::min(third_.length(v, 2), most)) / 2;
            own[v] = follows[v] && deviation[v] > 0 ? std::min(third_.length(v, 0) / deviation[v], most) : noise[v];
        });
        average(near_, own, 1, steps);
        average(near_, noise, 1, steps);
        for (std::size_t i = 0; i < out.size(); ++i)
            if (noise[i] > 0) out[i] *= own[i] / noise[i];
        return out;
    }

private:
    static std::vector<double> first_details(const Neighbours& near, const std::vector<double>& weight,
                                             const std::vector<double>& values) {
        std::vector<double> h(3 * values.size());
        for (Index v = 0; v < near.rows(); ++v) {
            h[3 * v] = values[v];
            for (int c = 1; c < 3; ++c) h[3 * v + c] = gaussian(v, 200 + c);
        }
        return detail(near, weight, h);
    }

    const Neighbours& near_;
    ValueLengths first_, third_;
};

std::vector<Index> all_vertices(const Neighbours& near) {
    std::vector<Index> all(near.rows());
    std::iota(all.begin(), all.end(), 0);
    return all;
}

/// Deviations of the cells; those of texture are no larger than the quieter ones among the others.
std::vector<double> of_cells(const std::vector<Found>& found, double everywhere) {
    std::vector<double> white, out;
    out.reserve(found.size());
    for (const Found& f : found)
        if (f.white && f.noise > 0) white.push_back(f.noise);
    const double most_of_texture = white.empty() ? everywhere : lower_quantile(white, 0.25);
    for (const Found& f : found) out.push_back(f.white ? f.noise : std::min(f.noise, most_of_texture));
    return out;
}

/// Moments of the deviations of cells.
struct Spread {
    double mean = 0, variance = 0;

    explicit Spread(const std::vector<double>& values) {
        for (const double x : values) mean += x / values.size();
        for (const double x : values) variance += (x - mean) * (x - mean) / values.size();
    }
};

}  // namespace

double field_noise(const Neighbours& near, const std::vector<double>& weight, const std::vector<double>& values) {
    return FieldNoise(near, weight, values).at(all_vertices(near), quiet_everywhere).noise;
}

std::vector<double> local_field_noise(const Neighbours& near, const std::vector<double>& weight,
                                      const Positions& positions, const std::vector<double>& values) {
    constexpr Index cell_size = 800;
    const FieldNoise noise(near, weight, values);
    const double everywhere = noise.at(all_vertices(near), quiet_everywhere).noise;
    std::vector<double> out(values.size(), everywhere);
    const std::vector<std::vector<Index>> cells = cells_of(positions, cell_size);
    if (cells.size() < 4) return out;
    std::vector<Found> found;
    for (const auto& cell : cells) found.push_back(noise.at(cell, quiet_in_cells));
    const std::vector<double> deviation = of_cells(found, everywhere);
    const Spread spread(deviation);
    // A quantile of so many vertices scatters by about a tenth.
    const double by_chance = 0.12 * spread.mean;
    if (!(spread.variance > 4 * by_chance * by_chance)) return out;
    std::vector<std::uint8_t> white(values.size(), 0);
    for (std::size_t k = 0; k < cells.size(); ++k)
        for (const Index v : cells[k]) out[v] = deviation[k], white[v] = found[k].white;
    constexpr int smoothing_steps = 150;
    average(near, out, 1, smoothing_steps);
    return noise.refined(out, white);
}

}  // namespace multires
