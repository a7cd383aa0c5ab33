#include "denoise/value_candidates.h"

#include "base/parallel.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>

namespace multires {
namespace {

/// Averaging steps that make the energy of each band local, and how many more of them for the noise's energy, which
/// varies with the sampling only.
constexpr std::array<int, 6> steps_of_level = {4, 6, 9, 15, 25, 40};
constexpr int noise_steps = 12;
constexpr double push = 0.2;  ///< in samples of the noise: measures how total variation answers

/// The values, the probe and another sample of noise, side by side at each vertex.
struct Fields {
    static constexpr int count = 3;
    int width = 1;               ///< channels of one field
    std::vector<double> values;  ///< #V by count by width
};

/// One step of each vertex towards the mean of its neighbours.
/// @param weight  #entries, rows that sum to 1; null: equal weights
template <int count>
void step(const Neighbours& near, const double* weight, const std::vector<double>& x, double factor,
          std::vector<double>& out) {
    using Row = Eigen::Matrix<double, count, 1>;
    const auto at = [](auto& values, Index v) { return values.data() + static_cast<std::size_t>(v) * count; };
    parallel_for(near.rows(), [&](Index v) {
        const Index begin = near.offset[v], end = near.offset[v + 1];
        const double equal = end > begin ? 1.0 / (end - begin) : 0;
        Row mean = Row::Zero();
        for (Index k = begin; k < end; ++k)
            mean += (weight ? weight[k] : equal) * Eigen::Map<const Row>(at(x, near.vertex[k]));
        const Eigen::Map<const Row> own(at(x, v));
        Eigen::Map<Row>(at(out, v)) = end > begin ? Row(own + factor * (mean - own)) : Row(own);
    });
}

/// Pairs of steps by these factors, of `fields` x `width` numbers at each vertex.
template <int fields>
void smooth(const Neighbours& near, const double* weight, std::vector<double>& x, int width,
            const std::array<double, 2>& factor, int pairs) {
    std::vector<double> next(x.size());
    const auto of_width = width == 1   ? step<fields>
                          : width == 2 ? step<2 * fields>
                          : width == 3 ? step<3 * fields>
                                       : step<4 * fields>;
    for (int pair = 0; pair < pairs; ++pair) {
        of_width(near, weight, x, factor[0], next);
        of_width(near, weight, next, factor[1], x);
    }
}

/// Calls f(at, i) for each number of #V by width: it is at `at` in the first of `fields` fields side by side.
template <int fields, class F>
void for_each_value(Index vertices, int width, const F& f) {
    parallel_for(vertices, [&](Index v) {
        for (int c = 0; c < width; ++c) {
            const std::size_t at = static_cast<std::size_t>(v) * width;
            f(fields * at + c, at + c);
        }
    });
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
            const double* at = band.values.data() + static_cast<std::size_t>(v) * band.width * Fields::count + c;
            const double d = at[0], b = at[band.width], other = at[2 * band.width];
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
            const double* at = band.values.data() + static_cast<std::size_t>(v) * band.width * Fields::count + c;
            moves.move[i] += gain * at[0];
            moves.response[i] += gain * at[band.width] + answer * at[0];
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
    const bool shrinks = any(wanted, first_wiener, value_severity.size());
    if (!shrinks && !any(wanted, first, levels)) return;
    const double* weight = cotangents ? weight_.data() : nullptr;
    const int width = noisy.width;
    const Index vertices = near_.rows();
    Fields start{width, std::vector<double>(Fields::count * noisy.values.size())};
    for_each_value<Fields::count>(vertices, width, [&](std::size_t at, std::size_t i) {
        start.values[at] = noisy.values[i];
        start.values[at + width] = noisy.probe[i];
        start.values[at + 2 * width] = noisy.deviation[i / width] * gaussian(static_cast<Index>(i), 310);
    });
    Fields low = start;
    const ValueMoves none{std::vector<double>(noisy.values.size(), 0), std::vector<double>(noisy.values.size(), 0)};
    std::vector<ValueMoves> shrunk(value_severity.size(), none);
    const auto add_low_pass = [&](ValueMoves& moves) {
        for_each_value<Fields::count>(vertices, width, [&](std::size_t at, std::size_t i) {
            moves.move[i] += low.values[at] - start.values[at];
            moves.response[i] += low.values[at + width] - start.values[at + width];
        });
    };
    int done = 0;
    for (std::size_t level = 0; level < levels && (shrinks || any(wanted, first + level, levels - level)); ++level) {
        Fields band = low;
        smooth<Fields::count>(near_, weight, low.values, width, {0.5, -0.5}, value_low_pass_steps[level] - done);
        done = value_low_pass_steps[level];
        if (wanted[first + level]) {
            ValueMoves moves = none;
            add_low_pass(moves);
            take(first + level, moves);
        }
        if (!shrinks) continue;
        parallel_for(vertices, [&](Index v) {
            const std::size_t stride = static_cast<std::size_t>(Fields::count) * width, at = v * stride;
            for (std::size_t i = at; i < at + stride; ++i) band.values[i] -= low.values[i];
        });
        const BandEnergy energy = energy_of(near_, band, steps_of_level[level]);
        for (std::size_t w = 0; w < shrunk.size(); ++w)
            if (wanted[first_wiener + w]) add_shrunk(near_, band, energy, value_severity[w], shrunk[w]);
    }
    for (std::size_t w = 0; w < shrunk.size(); ++w) {
        if (!wanted[first_wiener + w]) continue;
        add_low_pass(shrunk[w]);
        take(first_wiener + w, shrunk[w]);
    }
}

void ValueCandidateMaker::make_averages(const NoisyValues& noisy, const std::vector<std::uint8_t>& wanted,
                                        const Take& take) const {
    constexpr double share_of_neighbours = 0.85;
    static_assert(value_average_steps[0] % 2 == 0 && value_average_steps[1] % 2 == 0 &&
                  value_average_steps[2] % 2 == 0);  // smooth() takes pairs of steps
    const int width = noisy.width;
    std::vector<double> x(2 * noisy.values.size());  // and the probe
    for_each_value<2>(near_.rows(), width, [&](std::size_t at, std::size_t i) {
        x[at] = noisy.values[i];
        x[at + width] = noisy.probe[i];
    });
    int done = 0;
    for (std::size_t k = 0; k < value_average_steps.size(); ++k) {
        if (!any(wanted, first_average + k, value_average_steps.size() - k)) return;
        smooth<2>(near_, nullptr, x, width, {share_of_neighbours, share_of_neighbours},
                  (value_average_steps[k] - done) / 2);
        done = value_average_steps[k];
        if (!wanted[first_average + k]) continue;
        ValueMoves moves{std::vector<double>(noisy.values.size()), std::vector<double>(noisy.values.size())};
        for_each_value<2>(near_.rows(), width, [&](std::size_t at, std::size_t i) {
            moves.move[i] = x[at] - noisy.values[i];
            moves.response[i] = x[at + width] - noisy.probe[i];
        });
        take(first_average + k, moves);
    }
}

void ValueCandidateMaker::make_variations(const NoisyValues& noisy, const std::vector<std::uint8_t>& wanted,
                                          const Take& take) const {
    const int width = noisy.width;
    std::vector<double> both(2 * noisy.values.size());  // and pushed
    for_each_value<2>(near_.rows(), width, [&](std::size_t at, std::size_t i) {
        both[at] = noisy.values[i];
        both[at + width] = noisy.values[i] + push * noisy.probe[i];
    });
    for (std::size_t k = 0; k < variation_strength.size(); ++k) {
        if (!wanted[first_variation + k]) continue;
        const std::vector<double> after = variation_.denoised(both, width, noisy.deviation, variation_strength[k]);
        ValueMoves moves{std::vector<double>(noisy.values.size()), std::vector<double>(noisy.values.size())};
        for_each_value<2>(near_.rows(), width, [&](std::size_t at, std::size_t i) {
            moves.move[i] = after[at] - noisy.values[i];
            moves.response[i] = (after[at + width] - after[at]) / push - noisy.probe[i];
        });
        take(first_variation + k, moves);
    }
}

}  // namespace multires
