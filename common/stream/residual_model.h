#pragma once

#include "stream/bit_model.h"
#include "stream/two.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

namespace multires::stream {

/// Where two experts think that a number is: symmetric distributions about means, the first one logistic, the second
/// one Student's of two degrees of freedom, for what is right or quite wrong.
struct Experts {
    Two mean;
    Two over = 1;  ///< 1 / their widths

    /// Probabilities of more than x on a side of 0.
    /// @param side  1: above x; -1: below -x
    Two beyond(double x, double side) const {
        const Two t = (x - side * mean) * over;
        const double second = t.second();
        const Two shares = Two(1, 0.5) / Two(1 + exponential(t.first()), std::sqrt(1 + second * second));
        return {shares.first(), student(second, shares.second())};
    }

    /// The same on both sides.
    void beyond(double x, Two& below, Two& above) const {
        const Two from = x, t_below = (from + mean) * over, t_above = (from - mean) * over;
        const Two logistic(t_below.first(), t_above.first()), heavy(t_below.second(), t_above.second());
        const Two first = 1 / (1 + exponential(logistic)), half = 0.5 / root(1 + heavy * heavy);
        below = Two(first.first(), student(heavy.first(), half.first()));
        above = Two(first.second(), student(heavy.second(), half.second()));
    }

private:
    /// @param half  0.5 / sqrt(1 + t^2)
    static double student(double t, double half) {
        const double rest = t * half;
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
        Experts experts;
        int support = 0;  ///< 0..7 which weights to use
    };

    explicit ResidualModel(bool with_experts);

    /// @param opinions  null without experts
    std::int32_t code(BitCoder& coder, std::int32_t value, const Contexts& contexts, const Opinions* opinions);

private:
    static constexpr int nodes = 160, supports = 8;

    /// Of each expert, what it thinks of an interval and of the parts it is cut into.
    using Masses = Two;

    bool bit(BitCoder& coder, bool value, int node, Masses one, Masses none);
    int code_size(BitCoder& coder, std::uint32_t magnitude);
    std::uint32_t code_bits(BitCoder& coder, std::uint32_t magnitude, int size);
    Masses beyond(double x) const;

    std::unique_ptr<BitModel<7>> plain_;
    std::unique_ptr<BitModel<3, experts>> mixed_;
    const Contexts* contexts_ = nullptr;  ///< of the number that is being coded, as all that follows
    const Opinions* opinions_ = nullptr;
    double side_ = 1;
    Masses from_, past_;  ///< beyond the begin and the end of the interval it is known to be in
};

}  // namespace multires::stream
