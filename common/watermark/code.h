#pragma once

#include <array>
#include <cstdint>
#include <string>

/// The error-correcting code of watermarks: the convolutional code of rate 1/2 and constraint length 7 with the
/// generators 171 and 133 (octal; J. P. Odenwalder 1970), begun and ended in state 0.
namespace multires {

constexpr int message_bits = 64;
constexpr int code_memory = 6;
constexpr int code_bits = 2 * (message_bits + code_memory);

using Message = std::array<std::uint8_t, message_bits>;  ///< 0 or 1, the most significant bit first
using CodeWord = std::array<std::int8_t, code_bits>;     ///< 1 for a bit that is 0, -1 for one that is 1
using CodeValues = std::array<double, code_bits>;

/// @throws InputError  naming the parameter unless the text has 16 hexadecimal digits
Message message_of(const std::string& text, const char* parameter);
std::string text_of(const Message& message);

CodeWord encoded(const Message& message);

/// What is known of each bit of the message: log of the odds of 0 against 1, over all code words (Bahl, Cocke, Jelinek
/// and Raviv 1974).
/// @param odds  log of the odds of +1 against -1 for each bit of the code, as if they were independent
std::array<double, message_bits> decoded(const CodeValues& odds);

/// The largest sum of value x code word over all code words (Viterbi 1967).
double best_correlation(const CodeValues& values);

}  // namespace multires
