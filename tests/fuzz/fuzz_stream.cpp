#include "bytes.h"

#include "base/error.h"
#include "stream/decoder.h"

#include <cmath>
#include <vector>

// A .mrm file of any bytes. Checksums are made right first, or nothing behind them would ever be tried. Whatever is
// decoded before a fault is found must be a mesh; the bytes come in two parts.

namespace multires::fuzz {
namespace {

/// Writes the right checksum into every piece whose size makes sense.
void mend(std::vector<std::uint8_t>& bytes) {
    std::size_t at = sizeof stream::signature + 1;  // behind the version
    while (at + 6 <= bytes.size()) {
        const auto piece = static_cast<stream::Piece>(bytes[at++]);
        std::uint64_t size = 0;
        for (int shift = 0; at < bytes.size() && shift < 42; shift += 7) {
            size |= static_cast<std::uint64_t>(bytes[at] & 127) << shift;
            if (bytes[at++] < 128) break;
        }
        if (at + 4 > bytes.size() || size > bytes.size() - at - 4) return;
        const std::uint32_t sum = stream::checksum(piece, bytes.data() + at + 4, size);
        for (int i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(sum >> (8 * i));
        at += 4 + size;
    }
}

void check(const Layer& layer) {
    const auto n = static_cast<Index>(layer.mesh.positions.size());
    for (const Face& f : layer.mesh.faces)
        for (const Index v : f) FUZZ_REQUIRE(v >= 0 && v < n);
    for (const Attribute& a : layer.attributes)
        FUZZ_REQUIRE(a.values.size() == layer.mesh.positions.size() * static_cast<std::size_t>(a.width));
    FUZZ_REQUIRE(layer.wedges.empty() || layer.wedges.size() == 3 * layer.mesh.faces.size());
}

void decode(const std::vector<std::uint8_t>& bytes) {
    stream::Limits limits;
    limits.vertices = 100000;
    stream::Decoder decoder(limits);
    const std::size_t half = bytes.size() / 2;
    try {
        decoder.feed(bytes.data(), half);
        decoder.feed(bytes.data() + half, bytes.size() - half);
        worked += decoder.started();
    } catch (const InputError&) {
    }
    if (decoder.started() && decoder.vertices() < 200000) check(decoder.layer());
}

}  // namespace
}  // namespace multires::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::uint8_t> bytes(data, data + size);
    multires::fuzz::mend(bytes);
    multires::fuzz::decode(bytes);
    return 0;
}
