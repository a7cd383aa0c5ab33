#include "watermark/code.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace multires {
namespace {

constexpr int states = 1 << code_memory, steps = message_bits + code_memory;
constexpr double never = -std::numeric_limits<double>::infinity();
using Metric = std::array<double, states>;

int parity(int bits) {
    int sum = 0;
    for (; bits != 0; bits &= bits - 1) sum ^= 1;
    return sum;
}

/// One step: the register holds the bit that comes in above the state. Its parities with the generators go out.
struct Step {
    int next;
    std::array<int, 2> sign;  ///< 1 or -1
};

const std::array<std::array<Step, 2>, states>& trellis() {
    static const auto all = [] {
        std::array<std::array<Step, 2>, states> t{};
        for (int state = 0; state < states; ++state)
            for (int bit = 0; bit < 2; ++bit) {
                const int reg = state | bit << code_memory;
                t[state][bit] = {reg >> 1, {1 - 2 * parity(reg & 0171), 1 - 2 * parity(reg & 0133)}};
            }
        return t;
    }();
    return all;
}

/// Zeros alone follow the message.
int bits_of_step(int step) { return step < message_bits ? 2 : 1; }

double gain(const CodeValues& values, int step, const Step& taken) {
    return taken.sign[0] * values[2 * step] + taken.sign[1] * values[2 * step + 1];
}

/// log(exp(a) + exp(b))
double log_sum(double a, double b) {
    const double most = std::max(a, b);
    return most == never ? never : most + std::log1p(std::exp(std::min(a, b) - most));
}

/// Before each step: log of the sum over all ways from the start to a state.
std::vector<Metric> forward(const CodeValues& half) {
    std::vector<Metric> before(steps + 1);
    for (Metric& m : before) m.fill(never);
    before[0][0] = 0;
    for (int t = 0; t < steps; ++t)
        for (int s = 0; s < states; ++s)
            for (int bit = 0; bit < bits_of_step(t); ++bit) {
                const Step& way = trellis()[s][bit];
                before[t + 1][way.next] = log_sum(before[t + 1][way.next], before[t][s] + gain(half, t, way));
            }
    return before;
}

int digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

}  // namespace

Message message_of(const std::string& text, const char* parameter) {
    const bool good =
        text.size() == message_bits / 4 && std::all_of(text.begin(), text.end(), [](char c) { return digit(c) >= 0; });
    require(good, std::string(parameter) + " must be 64 bits as 16 hexadecimal digits, 0 to 9 and a to f");
    Message message;
    for (int i = 0; i < message_bits; ++i) message[i] = digit(text[i / 4]) >> (3 - i % 4) & 1;
    return message;
}

std::string text_of(const Message& message) {
    std::string text;
    for (int i = 0; i < message_bits; i += 4)
        text += "0123456789abcdef"[message[i] << 3 | message[i + 1] << 2 | message[i + 2] << 1 | message[i + 3]];
    return text;
}

CodeWord encoded(const Message& message) {
    CodeWord word;
    int state = 0;
    for (int t = 0; t < steps; ++t) {
        const Step& way = trellis()[state][t < message_bits ? message[t] : 0];
        for (int k = 0; k < 2; ++k) word[2 * t + k] = static_cast<std::int8_t>(way.sign[k]);
        state = way.next;
    }
    return word;
}

std::array<double, message_bits> decoded(const CodeValues& odds) {
    CodeValues half;
    for (int i = 0; i < code_bits; ++i) half[i] = odds[i] / 2;
    const std::vector<Metric> before = forward(half);
    std::array<double, message_bits> result{};
    Metric after;
    after.fill(never);
    after[0] = 0;
    for (int t = steps - 1; t >= 0; --t) {
        Metric here;
        here.fill(never);
        std::array<double, 2> all{never, never};
        for (int s = 0; s < states; ++s)
            for (int bit = 0; bit < bits_of_step(t); ++bit) {
                const Step& way = trellis()[s][bit];
                const double rest = gain(half, t, way) + after[way.next];
                here[s] = log_sum(here[s], rest);
                all[bit] = log_sum(all[bit], before[t][s] + rest);
            }
        if (t < message_bits) result[t] = all[0] - all[1];
        after = here;
    }
    return result;
}

double best_correlation(const CodeValues& values) {
    Metric best;
    best.fill(never);
    best[0] = 0;
    for (int t = 0; t < steps; ++t) {
        Metric next;
        next.fill(never);
        for (int s = 0; s < states; ++s)
            for (int bit = 0; bit < bits_of_step(t); ++bit) {
                const Step& way = trellis()[s][bit];
                next[way.next] = std::max(next[way.next], best[s] + gain(values, t, way));
            }
        best = next;
    }
    return best[0];
}

}  // namespace multires
