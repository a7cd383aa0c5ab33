#pragma once

#include "stream/bit_coder.h"
#include "stream/elementary.h"

#include <array>
#include <cstdint>
#include <vector>

namespace multires::stream {

/// A bit predicted by several contexts at once: each keeps an adaptive probability, and a logistic mixture whose
/// weights learn from every bit weighs them (Mahoney 2005, "Adaptive weighing of context models for lossless data
/// compression").
template <int contexts>
class BitModel {
public:
    /// @param sizes  how many values each context has
    /// @param sets   how many sets of weights there are to choose from
    BitModel(const std::array<int, contexts>& sizes, int sets, double rate = 0.006);

    /// Codes a bit with a BitCoder.
    /// @param context  a value of each context, 0 to its size - 1
    /// @param set      the weights to use
    bool code(BitCoder& coder, bool bit, const std::array<int, contexts>& context, int set);

private:
    struct Slot {
        float one = 0.5F;  ///< probability of a 1
        float count = 0;   ///< bits seen, up to a limit
    };
    using Weights = std::array<double, contexts + 1>;

    std::array<std::vector<Slot>, contexts> slots_;
    std::vector<Weights> weights_;
    double rate_;
};

}  // namespace multires::stream
