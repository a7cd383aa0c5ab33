#include "denoise/local_noise.h"

#include "base/median.h"
#include "base/parallel.h"
#include "mesh/cells.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace multires {
namespace {

constexpr double share_of_shape = 0.3;  ///< of the first differences that passes for noise in the third ones
constexpr double most_of_white = 1.2;   ///< first differences over third ones

double quantile(const std::vector<double>& length, const std::vector<Index>& vertices, int channel, double share) {
    std::vector<double> all;
    all.reserve(vertices.size());
    for (const Index v : vertices) all.push_back(length[3 * static_cast<std::size_t>(v) + channel]);
    return lower_quantile(all, share);
}

/// Deviations of the cells; those of texture are no larger than the quieter ones among the others.
/// @param deviation  Found::quiet or Found::noise
std::vector<double> of_cells(const std::vector<NoiseByDifferences::Found>& found,
                             double NoiseByDifferences::Found::*deviation, double everywhere) {
    std::vector<double> white, out;
    out.reserve(found.size());
    for (const auto& f : found)
        if (f.white && f.*deviation > 0) white.push_back(f.*deviation);
    const double most_of_texture = white.empty() ? everywhere : lower_quantile(white, 0.25);
    for (const auto& f : found) out.push_back(f.white ? f.*deviation : std::min(f.*deviation, most_of_texture));
    return out;
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Standard deviation over the mean.
double variation(const std::vector<double>& values) {
    double mean = 0, squares = 0;
    for (const double x : values) mean += x / static_cast<double>(values.size());
    for (const double x : values) squares += (x - mean) * (x - mean) / static_cast<double>(values.size());
    return mean > 0 ? std::sqrt(squares) / mean : 0;
}

}  // namespace

NoiseByDifferences::NoiseByDifferences(const Neighbours& near, const std::vector<double>& first,
                                       const std::vector<double>& third)
    : near_(near), first_(lengths(first)), third_(lengths(third)) {}

std::vector<double> NoiseByDifferences::lengths(const std::vector<double>& differences) const {
    constexpr int local_steps = 10;
    std::vector<double> energy(differences.size()), out(differences.size());
    for (std::size_t i = 0; i < energy.size(); ++i) energy[i] = differences[i] * differences[i];
    average(near_, energy, 3, local_steps);
    parallel_for(near_.rows(), [&](Index v) {
        const double local = std::sqrt((energy[3 * v + 1] + energy[3 * v + 2]) / 2);
        for (int c = 0; c < 3; ++c) out[3 * v + c] = local > 0 ? std::abs(differences[3 * v + c]) / local : -1;
    });
    return out;
}

double NoiseByDifferences::ratio(const std::vector<double>& length, const std::vector<Index>& vertices,
                                 double share) const {
    const double noise = (quantile(length, vertices, 1, share) + quantile(length, vertices, 2, share)) / 2;
    return noise > 0 ? quantile(length, vertices, 0, share) / noise : 0;
}

NoiseByDifferences::Found NoiseByDifferences::at(std::vector<Index> vertices, double quiet) const {
    const auto usable = [&](Index v, bool with_rim) {
        const std::size_t i = 3 * static_cast<std::size_t>(v);
        return (with_rim || !near_.rim[v]) && first_[i] >= 0 && third_[i] >= 0;
    };
    const bool with_rim = std::none_of(vertices.begin(), vertices.end(), [&](Index v) { return usable(v, false); });
    vertices.erase(std::remove_if(vertices.begin(), vertices.end(), [&](Index v) { return !usable(v, with_rim); }),
                   vertices.end());
    if (vertices.empty()) return {};
    // A step spoils the third differences of more vertices than it does the first.
    const double first = ratio(first_, vertices, quiet), third = ratio(third_, vertices, quiet);
    const double low = std::min(first, third);
    if (!(low > 0)) return {};
    const double shape = std::max(0.0, first * first - low * low);
    const double body = ratio(third_, vertices, 0.7) / third;
    const double believed = std::clamp((1.35 - body) / 0.2, 0.0, 1.0);
    const double deviation = std::sqrt(std::max(0.0, low * low - share_of_shape * share_of_shape * shape));
    return {deviation, believed * deviation, first < most_of_white * third};
}

std::vector<double> NoiseByDifferences::refined(const std::vector<double>& deviation,
                                                const std::vector<std::uint8_t>& follows) const {
    constexpr int steps = 60;
    constexpr double most = 2.5;
    std::vector<double> own(deviation.size(), 0), noise = own, out = deviation;
    parallel_for(near_.rows(), [&](Index v) {
        const double* length = third_.data() + 3 * static_cast<std::size_t>(v);
        if (length[0] < 0) return;
        noise[v] = (std::min(length[1], most) + std::min(length[2], most)) / 2;
        own[v] = follows[v] && deviation[v] > 0 ? std::min(length[0] / deviation[v], most) : noise[v];
    });
    average(near_, own, 1, steps);
    average(near_, noise, 1, steps);
    for (std::size_t i = 0; i < out.size(); ++i)
        if (noise[i] > 0) out[i] *= own[i] / noise[i];
    return out;
}

std::vector<double> NoiseByDifferences::varying(const Positions& positions, double everywhere, double least) const {
    constexpr Index cell_size = 800;
    constexpr double quiet = 0.3;  // of so few vertices a lower quantile would scatter
    const std::vector<std::vector<Index>> cells = cells_of(positions, cell_size);
    if (cells.size() < 4) return {};
    std::vector<Found> found;
    found.reserve(cells.size());
    for (const auto& cell : cells) found.push_back(at(cell, quiet));
    const std::vector<double> quiet_part = of_cells(found, &Found::quiet, everywhere),
                              deviation = of_cells(found, &Found::noise, everywhere);
    // Impulses and texture leave a share of the cells that is not believed.
    constexpr double mostly = 0.7, quietest = 0.05;
    if (!(variation(quiet_part) > least) || sum(deviation) < mostly * sum(quiet_part)) return {};
    // Where two thirds of the cells have texture the others are likely to have some; what is not there at all in a
    // tenth of the cells is shape of the others.
    const auto white_cells = std::count_if(found.begin(), found.end(), [](const Found& f) { return f.white; });
    if (3 * static_cast<std::size_t>(white_cells) < found.size()) return {};
    std::vector<double> sorted = quiet_part;
    if (lower_quantile(sorted, 0.1) < quietest * sum(quiet_part) / static_cast<double>(cells.size())) return {};
    std::vector<double> out(positions.size(), 0);
    std::vector<std::uint8_t> white(positions.size(), 0);
    for (std::size_t k = 0; k < cells.size(); ++k)
        for (const Index v : cells[k]) out[v] = deviation[k], white[v] = found[k].white;
    constexpr int smoothing_steps = 150;
    average(near_, out, 1, smoothing_steps);
    return refined(out, white);
}

}  // namespace multires
