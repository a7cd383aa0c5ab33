#include "stream/residual_model.h"

#include <algorithm>
#include <cstdlib>

namespace multires::stream {
namespace {

constexpr int sign_node = 1, size_node = 2, bits_node = 34, most = 31;

/// ln(a / b) within limits.
Two log_ratio(Two a, Two b) {
    constexpr double least = 1e-9, limit = 9;
    return smaller(larger(0.6931471805599453 * logarithm((a + least) / (b + least)), -limit), limit);
}

}  // namespace

ResidualModel::ResidualModel(bool with_experts) {
    constexpr int n = nodes * 64;
    if (with_experts)
        mixed_ = std::make_unique<BitModel<3, experts>>(std::array<int, 3>{n, n, n}, nodes * supports,
                                                        Learning{0.012, 8, 120});
    else
        plain_ = std::make_unique<BitModel<7>>(std::array<int, 7>{n, n, n, n, n, n, nodes * 16}, nodes);
}

bool ResidualModel::bit(BitCoder& coder, bool value, int node, Masses one, Masses none) {
    const Contexts& c = *contexts_;
    const int at = node * 64;
    if (mixed_) {
        const Two opinion = log_ratio(larger(one, 0), larger(none, 0));
        return mixed_->code(coder, value, {at + c.expected, at + c.spread, at + c.lean},
                            node * supports + opinions_->support, {opinion.first(), opinion.second()});
    }
    return plain_->code(coder, value,
                        {at + c.expected, at + c.spread, at + c.memory, at + c.other, at + c.lean,
                         at + std::min(c.expected / 6, 7) * 8 + std::min(c.memory / 3, 7), node * 16 + c.kind},
                        node);
}

ResidualModel::Masses ResidualModel::beyond(double x) const {
    return mixed_ ? opinions_->experts.beyond(x, side_) : Masses();
}

std::int32_t ResidualModel::code(BitCoder& coder, std::int32_t value, const Contexts& contexts,
                                 const Opinions* opinions) {
    contexts_ = &contexts, opinions_ = opinions;
    Masses below, above;
    if (mixed_) opinions_->experts.beyond(0.5, below, above);
    const Masses outside = below + above, zero = 1 - outside;
    if (bit(coder, value == 0, 0, zero, outside)) return 0;
    const bool negative = bit(coder, value < 0, sign_node, below, above);
    side_ = negative ? -1 : 1;
    from_ = negative ? below : above;
    const auto magnitude = static_cast<std::uint32_t>(std::abs(static_cast<std::int64_t>(value)));
    const int size = code_size(coder, magnitude);
    const auto out = static_cast<std::int32_t>(code_bits(coder, magnitude, size));
    return negative ? -out : out;
}

/// How many bits there are below the leading one.
int ResidualModel::code_size(BitCoder& coder, std::uint32_t magnitude) {
    int size = 0;
    for (; size < most - 1; ++size) {
        past_ = beyond(power_of_two(size + 1) - 0.5);
        if (!bit(coder, magnitude >> (size + 1) != 0, size_node + size, past_, from_ - past_)) break;
        from_ = past_;
    }
    return size;
}

std::uint32_t ResidualModel::code_bits(BitCoder& coder, std::uint32_t magnitude, int size) {
    constexpr int modelled = 2;
    std::uint32_t out = 1;
    for (int i = size - 1; i >= 0; --i) {
        const bool b = magnitude >> i & 1;
        const int known = size - 1 - i;  // leading bits
        if (known >= modelled) {
            out = out << 1 | coder.code_plain(b, 1);
            continue;
        }
        const Masses middle = beyond(static_cast<double>((out << 1 | 1) << i) - 0.5);
        const int node = bits_node + 4 * size + (known == 0 ? 0 : 1 + static_cast<int>(out & 1));
        const bool up = bit(coder, b, node, middle - past_, from_ - middle);
        (up ? from_ : past_) = middle;
        out = out << 1 | static_cast<std::uint32_t>(up);
    }
    return out;
}

}  // namespace multires::stream
