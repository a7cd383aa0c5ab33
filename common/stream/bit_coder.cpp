#include "stream/bit_coder.h"

namespace multires::stream {

BitCoder::BitCoder(const std::uint8_t* data, std::size_t size) : reads_(true), data_(data), size_(size) {
    for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next();
}

bool BitCoder::code(bool bit, std::uint32_t one) {
    const std::uint32_t range = high_ - low_;
    const std::uint32_t middle = low_ + static_cast<std::uint32_t>((static_cast<std::uint64_t>(range) * one) >> 16);
    if (reads_) bit = code_ <= middle;
    if (bit)
        high_ = middle;
    else
        low_ = middle + 1;
    while (((low_ ^ high_) & 0xff000000) == 0) {
        if (reads_)
            code_ = code_ << 8 | next();
        else
            written_.push_back(static_cast<std::uint8_t>(high_ >> 24));
        low_ <<= 8;
        high_ = high_ << 8 | 255;
    }
    return bit;
}

std::uint32_t BitCoder::code_plain(std::uint32_t value, int count) {
    std::uint32_t out = 0;
    for (int i = count - 1; i >= 0; --i) out = out << 1 | static_cast<std::uint32_t>(code(value >> i & 1, 1 << 15));
    return out;
}

std::vector<std::uint8_t> BitCoder::finish() {
    // The shortest number between low and high; the zeros that follow need not be written.
    std::vector<std::uint8_t> out = std::move(written_);
    for (int bytes = 1; bytes <= 4; ++bytes) {
        const std::uint32_t mask = bytes < 4 ? 0xffffffffU >> (8 * bytes) : 0;
        const std::uint64_t up = (static_cast<std::uint64_t>(low_) + mask) & ~static_cast<std::uint64_t>(mask);
        if (up > high_) continue;
        for (int i = 0; i < bytes; ++i) out.push_back(static_cast<std::uint8_t>(up >> (24 - 8 * i)));
        break;
    }
    while (!out.empty() && out.back() == 0) out.pop_back();
    *this = BitCoder();
    return out;
}

}  // namespace multires::stream
