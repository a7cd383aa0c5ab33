#include "denoise/value_candidates.h"

#include "base/parallel.h"

#include <algorithm>

namespace multires {
namespace {

/// Averaging steps that make the energy of each band local, and how many more of them for the noise's energy, which
/// varies with the sampling only.
constexpr std::array<int, 6> steps_of_level = {4, 6, 9, 15, 25, 40};
constexpr int noise_steps = 12;
constexpr double push = 0.2;  ///< in samples of the noise: measures how total variation answers

/// Three fields side by side: the values, the probe and another sample of noise.
struct Fields {
    static constexpr int count = 3;
    int width = 1;                             ///< channels of one field
    std::array<std::vector<double>, 3> field;  ///< #V by width each
};

/// @param weight  #entries, rows that sum to 1; empty: equal weights
std::vector<double> step_of(const Neighbours& near, const std::vector<double>& weight, const std::vector<double>& x,
                            int width, double factor) {
    std::vector<double> out(x.size());
    parallel_for(near.rows(), [&](Index v) {
        std::array<double, 4> mean{};
        const double equal = near.size(v) > 0 ? 1.0 / near.size(v) : 0;
        for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) {
            const double w = weight.empty() ? equal : weight[k];
            const double* other = x.data() + static_cast<std::size_t>(near.vertex[k]) * width;
            for (int c = 0; c < width; ++c) mean[c] += w * other[c];
        }
        const std::size_t at = static_cast<std::size_t>(v) * width;
        for (int c = 0; c < width; ++c)
            out[at + c] = near.size(v) > 0 ? x[at + c] + factor * (mean[c] - x[at + c]) : x[at + c];
    });
    return out;
}

void smooth(const Neighbours& near, const std::vector<double>& weight, Fields& fields, int pairs) {
    for (std::vector<double>& x : fields.field)
        for (int pair = 0; pair < pairs; ++pair)
            x = step_of(near, weight, step_of(near, weight, x, fields.width, 0.5), fields.width, -0.5);
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> out(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) out[i] = a[i] - b[i];
    return out;
}

/// Local means over all channels of a band between two low passes.
struct BandEnergy {
    std::vector<double> mean;   ///< #V by 3: energy of the values, their product with the probe, energy of noise
    std::vector<double> noise;  ///< #V: the last, averaged over more
};

BandEnergy energy_of(const Neighbours& near, const Fields& band, int steps) {
    BandEnergy e;
    e.mean.assign(3 * static_cast<std::size_t>(near.rows()), 0);
    e.noise.resize(near.rows());
    parallel_for(near.rows(), [&](Index v) {
        for (int c = 0; c < band.width; ++c) {
            const std::size_t i = static_cast<std::size_t>(v) * band.width + c;
            const double d = band.field[0][i], b = band.field[1][i], other = band.field[2][i];
            e.mean[3 * v] += d * d;
            e.mean[3 * v + 1] += d * b;
            e.mean[3 * v + 2] += other * other;  // not b's, or the gains would know the probe
        }
    });
    average(near, e.mean, 3, steps);
    parallel_for(near.rows(), [&](Index v) { e.noise[v] = e.mean[3 * static_cast<std::size_t>(v) + 2]; });
    average(near, e.noise, 1, noise_steps);
    return e;
}

/// Gives the shrunk band back to what the low passes left: moves += gain x detail.
void add_shrunk(const Neighbours& near, const Fields& band, const BandEnergy& e, double severity, ValueMoves& moves) {
    parallel_for(near.rows(), [&](Index v) {
        // The gain 1 - noise / energy, and how it answers the probe: energy answers with twice the mean of d b.
        const double energy = e.mean[3 * static_cast<std::size_t>(v)], noise = severity * e.noise[v];
        if (!(energy > noise)) return;
        const double gain = 1 - noise / energy,
                     answer = 2 * noise * e.mean[3 * static_cast<std::size_t>(v) + 1] / (energy * energy);
        for (int c = 0; c < band.width; ++c) {
            const std::size_t i = static_cast<std::size_t>(v) * band.width + c;
            moves.move[i] += gain * band.field[0][i];
            moves.response[i] += gain * band.field[1][i] + answer * band.field[0][i];
        }
    });
}

bool any(const std::vector<std::uint8_t>& wanted, std::size_t first, std::size_t count) {
    const auto begin = wanted.begin() + static_cast<std::ptrdiff_t>(first);
    return std::any_of(begin, begin + static_cast<std::ptrdiff_t>(count), [](std::uint8_t w) { return w != 0; });
}

/// Where the families begin.
constexpr std::size_t low_passes(bool cotangents) {
    return cotangents ? value_low_pass_steps.size() : equal_low_passes;
}
constexpr std::size_t first_equal = low_passes(true) + value_severity.size(),
                      first_average = first_equal + low_passes(false) + value_severity.size(),
                      first_variation = first_average + value_average_steps.size();

}  // namespace

std::vector<ValueCandidate> value_candidates() {
    std::vector<ValueCandidate> all;
    const auto add = [&](ValueFamily family, std::size_t count, bool cotangents) {
        for (std::size_t i = 0; i < count; ++i) all.push_back({family, static_cast<int>(i), cotangents});
    };
    for (const bool cotangents : {true, false}) {
        add(ValueFamily::low_pass, low_passes(cotangents), cotangents);
        add(ValueFamily::wiener, value_severity.size(), cotangents);
    }
    add(ValueFamily::average, value_average_steps.size(), false);
    add(ValueFamily::total_variation, variation_strength.size(), false);
    return all;
}

void ValueCandidateMaker::make(const NoisyValues& noisy, const std::vector<std::uint8_t>& wanted,
                               const Take& take) const {
    make_bands(noisy, true, wanted, take);
    make_bands(noisy, false, wanted, take);
    make_averages(noisy, wanted, take);
    make_variations(noisy, wanted, take);
}

void ValueCandidateMaker::make_bands(const NoisyValues& noisy, bool cotangents, const std::vector<std::uint8_t>& wanted,
                                     const Take& take) const {
    const std::size_t first = cotangents ? 0 : first_equal, levels = low_passes(cotangents),
                      first_wiener = first + levels;
    if (!any(wanted, first, levels + value_severity.size())) return;
    const std::vector<double> equal, &weight = cotangents ? weight_ : equal;
    std::vector<double> other(noisy.values.size());
    for (std::size_t i = 0; i < other.size(); ++i)
        other[i] = noisy.deviation[i / noisy.width] * gaussian(static_cast<Index>(i), 310);
    const Fields start{noisy.width, {noisy.values, noisy.probe, other}};
    Fields low = start;
    std::vector<ValueMoves> shrunk(value_severity.size());
    for (ValueMoves& moves : shrunk) moves.move = moves.response = std::vector<double>(other.size(), 0);
    int done = 0;
    for (std::size_t level = 0; level < levels; ++level) {
        Fields band = low;
        smooth(near_, weight, low, value_low_pass_steps[level] - done);
        done = value_low_pass_steps[level];
        for (int f = 0; f < Fields::count; ++f) band.field[f] = difference(band.field[f], low.field[f]);
        if (wanted[first + level])
            take(first + level, {difference(low.field[0], start.field[0]), difference(low.field[1], start.field[1])});
        if (!any(wanted, first_wiener, value_severity.size())) continue;
        const BandEnergy energy = energy_of(near_, band, steps_of_level[level]);
        for (std::size_t w = 0; w < shrunk.size(); ++w)
            if (wanted[first_wiener + w]) add_shrunk(near_, band, energy, value_severity[w], shrunk[w]);
    }
    for (std::size_t w = 0; w < shrunk.size(); ++w) {
        if (!wanted[first_wiener + w]) continue;
        for (std::size_t i = 0; i < other.size(); ++i) {
            shrunk[w].move[i] += low.field[0][i] - start.field[0][i];
            shrunk[w].response[i] += low.field[1][i] - start.field[1][i];
        }
        take(first_wiener + w, shrunk[w]);
    }
}

void ValueCandidateMaker::make_averages(const NoisyValues& noisy, const std::vector<std::uint8_t>& wanted,
                                        const Take& take) const {
    if (!any(wanted, first_average, value_average_steps.size())) return;
    std::vector<double> x = noisy.values, b = noisy.probe;
    constexpr double share_of_neighbours = 0.85;
    int done = 0;
    for (std::size_t i = 0; i < value_average_steps.size(); ++i) {
        for (; done < value_average_steps[i]; ++done) {
            x = step_of(near_, {}, x, noisy.width, share_of_neighbours);
            b = step_of(near_, {}, b, noisy.width, share_of_neighbours);
        }
        if (wanted[first_average + i])
            take(first_average + i, {difference(x, noisy.values), difference(b, noisy.probe)});
    }
}

void ValueCandidateMaker::make_variations(const NoisyValues& noisy, const std::vector<std::uint8_t>& wanted,
                                          const Take& take) const {
    std::vector<double> pushed = noisy.values;
    for (std::size_t i = 0; i < pushed.size(); ++i) pushed[i] += push * noisy.probe[i];
    for (std::size_t k = 0; k < variation_strength.size(); ++k) {
        if (!wanted[first_variation + k]) continue;
        const auto after = variation_.denoised(noisy.values, noisy.width, noisy.deviation, variation_strength[k]),
                   after_push = variation_.denoised(pushed, noisy.width, noisy.deviation, variation_strength[k]);
        ValueMoves moves{difference(after, noisy.values), difference(after_push, after)};
        for (std::size_t i = 0; i < pushed.size(); ++i) moves.response[i] = moves.response[i] / push - noisy.probe[i];
        take(first_variation + k, moves);
    }
}

}  // namespace multires
