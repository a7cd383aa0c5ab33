#pragma once

#include "stream/bit_coder.h"
#include "stream/elementary.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace multires::stream {

/// How fast models learn. As it is here: files of versions 1 and 2.
struct Learning {
    double rate = 0.006;  ///< of weights
    double haste = 0;     ///< by how much faster weights learn from their first bits
    float memory = 250;   ///< bits after which a context's probability no longer learns more slowly
};

/// A context's value, from 0 to `most`.
inline int clamp(int x, int most) { return std::min(std::max(x, 0), most); }

/// A bit predicted by several contexts at once: each keeps an adaptive probability, and a logistic mixture whose
/// weights learn from every bit weighs them (Mahoney 2005, "Adaptive weighing of context models for lossless data
/// compression"). Experts, which have opinions of their own, are weighed with them.
template <int contexts, int experts = 0>
class BitModel {
public:
    /// @param sizes  how many values each context has
    /// @param sets   how many sets of weights there are to choose from
    BitModel(const std::array<int, contexts>& sizes, int sets, const Learning& learning = {});

    /// Codes a bit with a BitCoder.
    /// @param context  a value of each context, 0 to its size - 1
    /// @param set      the weights to use
    /// @param opinion  of each expert: ln(p / (1 - p)) of a 1
    bool code(BitCoder& coder, bool bit, const std::array<int, contexts>& context, int set,
              const std::array<double, experts>& opinion = {});

private:
    struct Slot {
        float one = 0.5F;  ///< probability of a 1
        float count = 0;   ///< bits seen, up to a limit
    };
    static constexpr int inputs = contexts + 1 + experts;  ///< contexts, a constant, experts
    struct Weights {
        std::array<double, inputs> weight;
        double seen = 0;  ///< bits
    };

    std::array<std::vector<Slot>, contexts> slots_;
    std::vector<Weights> weights_;
    Learning learning_;
};

}  // namespace multires::stream
