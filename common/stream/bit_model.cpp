#include "stream/bit_model.h"

#include <algorithm>
#include <cstring>

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

/// 2^exponent, for -1022 < exponent < 1024.
double power_of_two(int exponent) {
    const std::uint64_t bits = static_cast<std::uint64_t>(exponent + 1023) << 52;
    double out = 0;
    std::memcpy(&out, &bits, sizeof out);
    return out;
}

/// x / 2^exponent in [1, 2), of a positive number that is not denormal.
double mantissa(double x, int& exponent) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    exponent = static_cast<int>(bits >> 52 & 2047) - 1023;
    bits = (bits & 0x000fffffffffffffU) | 0x3ff0000000000000U;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

constexpr float most_seen = 250;

}  // namespace

double exponential(double x) {
    x = std::min(std::max(x, -40.0), 40.0);
    const double steps = static_cast<double>(static_cast<int>(x * 1.4426950408889634 + 64.5) - 64);
    const double r = x - steps * 0.6931471805599453;
    const double rr = r * r;  // |r| < 0.35: seven terms are good to 1e-8
    const double sum = 1 + r + rr * (0.5 + r / 6 + rr * (1.0 / 24 + r / 120 + rr * (1.0 / 720)));
    return sum * power_of_two(static_cast<int>(steps));
}

double logarithm(double x) {
    int exponent = 0;
    double m = mantissa(x, exponent);
    if (m > 1.4142135623730951) m /= 2, ++exponent;
    const double z = (m - 1) / (m + 1), zz = z * z;
    return exponent + 2.8853900817779268 * z * (1 + zz * (1.0 / 3 + zz * (0.2 + zz * (1.0 / 7 + zz / 9))));
}

int octave_steps(double x, int per_octave) {
    constexpr double half = 1.4142135623730951, third = 1.2599210498948732, thirds = 1.5874010519681996;
    if (!(x > 0)) return -1000;
    int octave = 0;
    const double m = mantissa(x, octave);
    if (per_octave == 2) return 2 * octave + (m >= half ? 1 : 0);
    if (per_octave == 3) return 3 * octave + (m >= third ? 1 : 0) + (m >= thirds ? 1 : 0);
    return octave;
}

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
