#pragma once

#include "denoise/risk.h"
#include "denoise/total_variation.h"

#include <array>
#include <functional>
#include <string>

/// The denoised versions of values on a surface between which the risk decides (see values.h).
namespace multires {

/// Linear low passes, pairs of a step inwards and one outwards of the same length, with cotangents, which linear
/// functions pass on irregular triangles, too, and with equal weights; Wiener filters, which shrink each band between
/// those locally by 1 - severity x noise energy / energy, of all channels together; averages; and total variation.
enum class ValueFamily { low_pass, wiener, average, total_variation };

struct ValueCandidate {
    ValueFamily family;
    int index;                ///< into the family's array
    bool cotangents = false;  ///< of low passes and Wiener filters
};

constexpr std::array<int, 6> value_low_pass_steps = {1, 2, 5, 12, 30, 80};
constexpr std::size_t equal_low_passes = 5;  ///< so many of them with equal weights
constexpr std::array<double, 2> value_severity = {1, 2};
constexpr std::array<int, 3> value_average_steps = {8, 32, 128};
constexpr std::array<double, 3> variation_strength = {0.25, 0.5, 1};

/// All of them, in the order in which they are made.
std::vector<ValueCandidate> value_candidates();

/// Values that are to be denoised.
struct NoisyValues {
    int width = 1;                  ///< at most 4
    std::vector<double> values;     ///< #V by width, in units of each channel's noise
    std::vector<double> deviation;  ///< #V: of the noise, in these units
    std::vector<double> probe;      ///< #V by width: a sample of it
};

/// How a candidate moves the values, and how that answers the probe (see risk.h); each #V by width.
struct ValueMoves {
    std::vector<double> move, response;
};

/// Makes the candidates one after the other.
class ValueCandidateMaker {
public:
    /// @param weight  #entries: cotangent_weights() of the surface
    ValueCandidateMaker(const Neighbours& near, const std::vector<double>& weight, const TotalVariation& variation)
        : near_(near), weight_(weight), variation_(variation) {}

    /// Calls take(k, moves) for the candidates k that are wanted.
    /// @param wanted  #candidates; those not wanted are made only if others need them
    void make(const NoisyValues& noisy, const std::vector<std::uint8_t>& wanted,
              const std::function<void(std::size_t, const ValueMoves&)>& take) const;

private:
    using Take = std::function<void(std::size_t, const ValueMoves&)>;
    void make_bands(const NoisyValues& noisy, bool cotangents, const std::vector<std::uint8_t>& wanted,
                    const Take& take) const;
    void make_averages(const NoisyValues& noisy, const std::vector<std::uint8_t>& wanted, const Take& take) const;
    void make_variations(const NoisyValues& noisy, const std::vector<std::uint8_t>& wanted, const Take& take) const;

    const Neighbours& near_;
    const std::vector<double>& weight_;
    const TotalVariation& variation_;
};

}  // namespace multires
