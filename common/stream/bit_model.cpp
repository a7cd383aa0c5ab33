#include "stream/bit_model.h"

#include <algorithm>
#include <cmath>

namespace multires::stream {
namespace {

/// ln(p / (1 - p)) of p = (i + 1/2) / 4096.
class Stretch {
public:
    Stretch() {
        // The inverse of the logistic function by bisection: a logarithm of the library's may differ between machines.
        constexpr double margin = 1e-5;  // more than either function is wrong by
        for (int i = 0; i < size; ++i) {
            const double p = (i + 0.5) / size, about = 0.6931471805599453 * logarithm(p / (1 - p));
            double low = -12, high = 12;
            for (int k = 0; k < 50; ++k) {
                const double middle = (low + high) / 2;
                const bool less =
                    std::abs(middle - about) > margin ? middle < about : 1 / (1 + exponential(-middle)) < p;
                (less ? low : high) = middle;
            }
            value_[i] = low;
        }
    }
    double operator()(float p) const { return value_[static_cast<int>(p * size)]; }

private:
    static constexpr int size = 4096;
    std::array<double, size> value_;
};

/// One table for all kinds of models, so that it stays in the cache.
const Stretch& stretch_table() {
    static const Stretch table;
    return table;
}

constexpr double brief = 32;  ///< bits that weights learn from in haste

}  // namespace

template <int contexts, int experts>
BitModel<contexts, experts>::BitModel(const std::array<int, contexts>& sizes, int sets, const Learning& learning)
    : learning_(learning) {
    for (int i = 0; i < contexts; ++i) slots_[i].resize(sizes[i]);
    Weights start;
    start.weight.fill((contexts > 1 ? 1.3 / (contexts + 1) : 1) / (experts > 0 ? 2 : 1));
    start.weight[contexts] = 0;
    for (int i = contexts + 1; i < inputs; ++i) start.weight[i] = 1.0 / experts;
    weights_.assign(sets, start);
}

template <int contexts, int experts>
bool BitModel<contexts, experts>::code(BitCoder& coder, bool bit, const std::array<int, contexts>& context, int set,
                                       const std::array<double, experts>& opinion) {
    static const Stretch& stretch = stretch_table();
    std::array<Slot*, contexts> slot;
    std::array<double, inputs> input;
    std::array<double, inputs>& w = weights_[set].weight;
    double dot = 0;
    for (int i = 0; i < contexts; ++i) {
        slot[i] = &slots_[i][context[i]];
        input[i] = slot[i]->count > 0 ? stretch(slot[i]->one) : 0;
        dot += w[i] * input[i];
    }
    input[contexts] = 0.3;
    for (int i = 0; i < experts; ++i) input[contexts + 1 + i] = opinion[i];
    for (int i = contexts; i < inputs; ++i) dot += w[i] * input[i];
    const double p = 1 / (1 + exponential(-dot));
    const double scaled = std::min(std::max(p * 65536, 24.0), 65536 - 24.0);
    bit = coder.code(bit, static_cast<std::uint32_t>(scaled));
    const double miss = (bit ? 1 : 0) - p;
    double rate = learning_.rate;
    if (learning_.haste > 0) rate *= 1 + learning_.haste * brief / (brief + weights_[set].seen++);
    for (int i = 0; i < inputs; ++i) w[i] += rate * miss * input[i];
    for (Slot* s : slot) {
        s->one += ((bit ? 1.0F : 0.0F) - s->one) / (s->count + 1.6F);
        if (s->count < learning_.memory) s->count += 1;
    }
    return bit;
}

template class BitModel<3>;
template class BitModel<4>;
template class BitModel<5>;
template class BitModel<7>;
template class BitModel<3, 2>;

}  // namespace multires::stream
