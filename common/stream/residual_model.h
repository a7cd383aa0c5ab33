#pragma once

#include "stream/bit_model.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

namespace multires::stream {

/// Where a number is thought to be: a symmetric distribution about a mean.
struct Expert {
    double mean = 0;
    double over = 1;     ///< 1 / its width
    bool heavy = false;  ///< Student's of two degrees of freedom, for what is right or quite wrong; else logistic

    /// Probability of more than x on a side of 0.
    /// @param side  1: above x; -1: below -x
    double beyond(double x, double side) const {
        const double t = (x - side * mean) * over;
        if (!heavy) return 1 / (1 + exponential(t));
        const double half = 0.5 / std::sqrt(1 + t * t), rest = t * half;
        return t > 0 ? half * half / (0.5 + rest) : 0.5 - rest;
    }
};

/// A number coded as difference to a prediction: its sign, its order of magnitude and its leading bits by context and,
/// from version 3 of the file on, by what experts think of each.
class ResidualModel {
public:
    static constexpr int experts = 2;
    struct Contexts {
        int expected = 0;  ///< 0..63
        int spread = 0;    ///< 0..63 how far off it may be by the shape around it
        int lean = 0;      ///< 0..63 where in its cell the prediction lies
        int memory = 0;    ///< 0..63 how far off others near it were; this and what follows: without experts
        int kind = 0;      ///< 0..15 valence and the like
        int other = 0;     ///< 0..63 what is known of the other coordinates
    };
    /// What experts say, means relative to the prediction.
    struct Opinions {
        std::array<Expert, experts> expert;
        int support = 0;  ///< 0..7 which weights to use
    };

    explicit ResidualModel(bool with_experts);

    /// @param opinions  null without experts
    std::int32_t code(BitCoder& coder, std::int32_t value, const Contexts& contexts, const Opinions* opinions);

private:
    static constexpr int nodes = 160, supports = 8;

    /// Of each expert, what it thinks of an interval and of the parts it is cut into.
    using Masses = std::array<double, experts>;

    bool bit(BitCoder& coder, bool value, int node, const Masses& one, const Masses& none);
    int code_size(BitCoder& coder, std::uint32_t magnitude);
    std::uint32_t code_bits(BitCoder& coder, std::uint32_t magnitude, int size);
    Masses beyond(double x) const;

    std::unique_ptr<BitModel<7>> plain_;
    std::unique_ptr<BitModel<3, experts>> mixed_;
    const Contexts* contexts_ = nullptr;  ///< of the number that is being coded, as all that follows
    const Opinions* opinions_ = nullptr;
    double side_ = 1;
    Masses from_{}, past_{};  ///< beyond the begin and the end of the interval it is known to be in
};

}  // namespace multires::stream
