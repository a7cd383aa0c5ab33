#include "stream/bytes.h"

#include <zstd.h>

#include <new>

namespace multires::stream {
namespace {

constexpr int effort = 12;  // of zstd's 19: what more would save is below 1 %

std::uint64_t mask(int width) { return width < 8 ? (std::uint64_t{1} << (8 * width)) - 1 : ~std::uint64_t{0}; }

std::uint64_t zigzag(std::int64_t x, int width) {
    const int unused = 64 - 8 * width;
    x = static_cast<std::int64_t>(static_cast<std::uint64_t>(x) << unused) >> unused;  // wrapped around
    return (static_cast<std::uint64_t>(x) << 1 ^ static_cast<std::uint64_t>(x >> 63)) & mask(width);
}

}  // namespace

Bytes packed(const std::vector<std::int64_t>& numbers, int width) {
    Bytes planes(numbers.size() * width);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::uint64_t x = zigzag(numbers[i], width);
        for (int b = 0; b < width; ++b) planes[b * numbers.size() + i] = static_cast<std::uint8_t>(x >> (8 * b));
    }
    Bytes out(ZSTD_compressBound(planes.size()));
    const std::size_t size = ZSTD_compress(out.data(), out.size(), planes.data(), planes.size(), effort);
    if (ZSTD_isError(size)) throw std::bad_alloc();  // there is no other reason
    out.resize(size);
    const bool plain = size >= planes.size();  // a few bytes: the frame would be larger than they are
    ByteWriter all;
    all.number(plain ? 0 : size);
    all.add(plain ? planes : out);
    return std::move(all.bytes());
}

std::vector<std::int64_t> unpacked(ByteReader& in, std::size_t count, int width) {
    const std::size_t size = in.number_up_to(in.left());
    Bytes planes;
    if (size == 0) {
        require(count <= in.left() / width, "the stream is damaged: a table has another size");
        planes.assign(in.rest(), in.rest() + count * width);
        in.skip(planes.size());
    } else {
        const unsigned long long claimed = ZSTD_getFrameContentSize(in.rest(), size);
        require(claimed == static_cast<unsigned long long>(count) * width,
                "the stream is damaged: a table has another size");
        planes.resize(count * width);
        const std::size_t got = ZSTD_decompress(planes.data(), planes.size(), in.rest(), size);
        require(!ZSTD_isError(got) && got == planes.size(), "the stream is damaged: a table cannot be unpacked");
        in.skip(size);
    }
    std::vector<std::int64_t> out(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::uint64_t x = 0;
        for (int b = 0; b < width; ++b) x |= static_cast<std::uint64_t>(planes[b * count + i]) << (8 * b);
        out[i] = static_cast<std::int64_t>(x >> 1 ^ (~(x & 1) + 1));
    }
    return out;
}

}  // namespace multires::stream
