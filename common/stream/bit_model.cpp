#include "stream/bit_model.h"

#include <algorithm>

namespace multires::stream {
namespace {

/// ln(p / (1 - p)) of p = (i + 1/2) / 4096.
class Stretch {
public:
    Stretch() {
        // The inverse of the logistic function by bisection: a logarithm of the library's may differ between machines.
        for (int i = 0; i < size; ++i) {
            const double p = (i + 0.5) / size;
            double low = -12, high = 12;
            for (int k = 0; k < 50; ++k) {
                const double middle = (low + high) / 2;
                (1 / (1 + exponential(-middle)) < p ? low : high) = middle;
            }
            value_[i] = low;
        }
    }
    double operator()(float p) const { return value_[static_cast<int>(p * size)]; }

private:
    static constexpr int size = 4096;
    std::array<double, size> value_;
};

constexpr float most_seen = 250;

}  // namespace

template <int contexts>
BitModel<contexts>::BitModel(const std::array<int, contexts>& sizes, int sets, double rate) : rate_(rate) {
    for (int i = 0; i < contexts; ++i) slots_[i].resize(sizes[i]);
    Weights start;
    start.fill(contexts > 1 ? 1.3 / (contexts + 1) : 1);
    start[contexts] = 0;
    weights_.assign(sets, start);
}

template <int contexts>
bool BitModel<contexts>::code(BitCoder& coder, bool bit, const std::array<int, contexts>& context, int set) {
    static const Stretch stretch;
    std::array<Slot*, contexts> slot;
    std::array<double, contexts + 1> input;
    Weights& w = weights_[set];
    double dot = 0;
    for (int i = 0; i < contexts; ++i) {
        slot[i] = &slots_[i][context[i]];
        input[i] = slot[i]->count > 0 ? stretch(slot[i]->one) : 0;
        dot += w[i] * input[i];
    }
    input[contexts] = 0.3;
    dot += w[contexts] * input[contexts];
    const double p = 1 / (1 + exponential(-dot));
    const double scaled = std::min(std::max(p * 65536, 24.0), 65536 - 24.0);
    bit = coder.code(bit, static_cast<std::uint32_t>(scaled));
    const double miss = (bit ? 1 : 0) - p;
    for (int i = 0; i <= contexts; ++i) w[i] += rate_ * miss * input[i];
    for (Slot* s : slot) {
        s->one += ((bit ? 1.0F : 0.0F) - s->one) / (s->count + 1.6F);
        if (s->count < most_seen) s->count += 1;
    }
    return bit;
}

template class BitModel<2>;
template class BitModel<3>;
template class BitModel<4>;
template class BitModel<5>;
template class BitModel<6>;
template class BitModel<7>;

}  // namespace multires::stream
