#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// The stream of a mesh: common/stream writes and reads the file format of docs/stream.md.
///
/// Encoder and decoder run the same code in the same order: what differs is a BitCoder that writes the bits it is
/// given, or reads them and ignores what it is given. Numbers that decisions hang on are doubles made by + - * / and
/// square roots alone, in a fixed order and without fused operations, so that all machines come to the same ones.
namespace multires::stream {

/// Arithmetic coder of single bits whose probabilities are given (Witten, Neal, Cleary 1987, in the carryless binary
/// form). No library here has one with adaptive contexts: Draco's rANS codes backwards, which rules out models that
/// learn as they go.
class BitCoder {
public:
    /// A coder that writes.
    BitCoder() = default;
    /// A coder that reads `size` bytes, and zeros after them.
    BitCoder(const std::uint8_t* data, std::size_t size);

    bool reads() const { return reads_; }

    /// Codes one bit.
    /// @param bit  what to write; ignored by a coder that reads
    /// @param one  probability of a 1, in 1/65536, 1 to 65535
    /// @returns the bit
    bool code(bool bit, std::uint32_t one);

    /// The `count` lowest bits of a number, all equally likely.
    std::uint32_t code_plain(std::uint32_t value, int count);

    /// Bytes written so far, or read beyond the four that are looked ahead.
    std::size_t bytes() const { return reads_ ? at_ : written_.size(); }

    /// Ends writing and starts anew. @returns what was written
    std::vector<std::uint8_t> finish();

private:
    std::uint8_t next() { return at_ < size_ ? data_[at_++] : 0; }

    bool reads_ = false;
    std::uint32_t low_ = 0, high_ = 0xffffffff, code_ = 0;
    const std::uint8_t* data_ = nullptr;
    std::size_t size_ = 0, at_ = 0;
    std::vector<std::uint8_t> written_;
};

}  // namespace multires::stream
