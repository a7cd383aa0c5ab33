#pragma once

#include "base/error.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace multires::stream {

using Bytes = std::vector<std::uint8_t>;

/// Writes numbers as bytes: little-endian, or seven bits a byte with the lowest first.
class ByteWriter {
public:
    void byte(std::uint8_t x) { bytes_.push_back(x); }
    void number(std::uint64_t x) {
        for (; x >= 128; x >>= 7) byte(static_cast<std::uint8_t>(x | 128));
        byte(static_cast<std::uint8_t>(x));
    }
    void word(std::uint64_t x, int bytes) {
        for (int i = 0; i < bytes; ++i) byte(static_cast<std::uint8_t>(x >> (8 * i)));
    }
    void real(double x) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &x, sizeof bits);
        word(bits, 8);
    }
    void text(const std::string& s) {
        number(s.size());
        bytes_.insert(bytes_.end(), s.begin(), s.end());
    }
    void add(const Bytes& more) { bytes_.insert(bytes_.end(), more.begin(), more.end()); }

    Bytes& bytes() { return bytes_; }

private:
    Bytes bytes_;
};

/// Reads them. @throws InputError  beyond the end
class ByteReader {
public:
    ByteReader(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

    std::uint8_t byte() {
        require(at_ < size_, "the stream is damaged: a piece ends too early");
        return data_[at_++];
    }
    std::uint64_t number() {
        std::uint64_t out = 0;
        for (int shift = 0; shift < 64; shift += 7) {
            const std::uint8_t b = byte();
            out |= static_cast<std::uint64_t>(b & 127) << shift;
            if (b < 128) return out;
        }
        throw InputError("the stream is damaged: a number does not end");
    }
    /// A number that must be at most `most`.
    std::uint64_t number_up_to(std::uint64_t most) {
        const std::uint64_t x = number();
        require(x <= most, "the stream is damaged: a number is too large");
        return x;
    }
    std::uint64_t word(int bytes) {
        std::uint64_t out = 0;
        for (int i = 0; i < bytes; ++i) out |= static_cast<std::uint64_t>(byte()) << (8 * i);
        return out;
    }
    double real() {
        const std::uint64_t bits = word(8);
        double x = 0;
        std::memcpy(&x, &bits, sizeof x);
        return x;
    }
    std::string text() {
        std::string out;
        for (std::uint64_t n = number_up_to(size_ - at_); n > 0; --n) out.push_back(static_cast<char>(byte()));
        return out;
    }
    const std::uint8_t* rest() const { return data_ + at_; }
    std::size_t left() const { return size_ - at_; }
    void skip(std::size_t n) { at_ += n; }

private:
    const std::uint8_t* data_;
    std::size_t size_, at_ = 0;
};

/// Whole numbers, most of them small, packed: zigzag, one plane for each byte, zstd. Done with a library: what is
/// packed this way is either little or has no geometry to be predicted from.
/// @param width  bytes a number has, 1 to 8; differences wrap around
Bytes packed(const std::vector<std::int64_t>& numbers, int width);

/// @param count  how many there are, checked against what the bytes hold before memory is taken
/// @throws InputError
std::vector<std::int64_t> unpacked(ByteReader& in, std::size_t count, int width);

}  // namespace multires::stream
