#include "stream/format.h"

#include "base/hash.h"

#include <algorithm>
#include <cmath>

namespace multires::stream {
namespace {

constexpr std::uint64_t most_elements = 0x7fffffff / 4;  ///< half-edges are 32-bit numbers
/// Vertices a byte can stand for: no split takes less than a 1024th of a byte.
constexpr std::uint64_t most_per_byte = 1024;
constexpr double bulge_steps = 64;
constexpr int same_flag = 128;  ///< of an attribute's bytes a number: all vertices have the numbers behind its name

void read_column(ByteReader& in, Header::Column& c) {
    const int kind = in.byte();
    c.width = in.byte();
    const int storage = in.byte(), bytes = storage & ~same_flag;
    require(kind <= static_cast<int>(AttributeKind::point) && c.width >= 1 && c.width <= 4 &&
                (bytes == 1 || bytes == 4 || bytes == 8),
            "the stream is damaged: an attribute's kind");
    c.kind = static_cast<AttributeKind>(kind);
    c.storage = static_cast<Storage>(bytes);
    c.name = in.text();
    if ((storage & same_flag) == 0) return;
    for (int i = 0; i < c.width; ++i) c.same.push_back(static_cast<std::int64_t>(in.word(bytes)));
}

}  // namespace

void Header::write(ByteWriter& out) const {
    out.number(bytes);
    for (const Index n : {vertices, faces, base_vertices, base_faces}) out.number(n);
    out.byte(static_cast<std::uint8_t>(bits));
    out.byte(static_cast<std::uint8_t>(base_bits));
    for (int i = 0; i < 3; ++i) out.real(origin[i]);
    out.real(step);
    out.byte(static_cast<std::uint8_t>(bulge * bulge_steps));
    out.number(columns.size());
    for (const Column& c : columns) {
        out.byte(static_cast<std::uint8_t>(c.kind));
        out.byte(static_cast<std::uint8_t>(c.width));
        out.byte(static_cast<std::uint8_t>(static_cast<int>(c.storage) | (c.same.empty() ? 0 : same_flag)));
        out.text(c.name);
        for (const std::int64_t x : c.same) out.word(static_cast<std::uint64_t>(x), width_of(c.storage));
    }
}

void Header::read(ByteReader& in) {
    bytes = in.number();
    const std::uint64_t most = std::min(most_elements, bytes > most_elements ? most_elements : bytes * most_per_byte);
    vertices = static_cast<Index>(in.number_up_to(most));
    faces = static_cast<Index>(in.number_up_to(most));
    base_vertices = static_cast<Index>(in.number_up_to(vertices));
    base_faces = static_cast<Index>(in.number_up_to(faces));
    bits = static_cast<int>(in.byte());
    base_bits = static_cast<int>(in.byte());
    require(bits >= 1 && bits <= 24 && base_bits >= 1 && base_bits <= bits,
            "the stream is damaged: its number of bits");
    for (int i = 0; i < 3; ++i) origin[i] = in.real();
    step = in.real();
    bulge = in.byte() / bulge_steps;
    require(origin.allFinite() && std::isfinite(step), "the stream is damaged: its box");
    columns.resize(in.number_up_to(most_attributes));
    for (Column& c : columns) read_column(in, c);
}

Vec3 Header::place(const Cell& cell, int bits_less) const {
    const double scale = static_cast<double>(1 << bits_less), middle = (scale - 1) / 2;
    return {origin[0] + (cell[0] * scale + middle) * step, origin[1] + (cell[1] * scale + middle) * step,
            origin[2] + (cell[2] * scale + middle) * step};
}

std::uint32_t checksum(Piece piece, const std::uint8_t* payload, std::size_t size) {
    Hash hash;
    hash.add(&piece, 1);
    hash.add(payload, size);
    return static_cast<std::uint32_t>(hash.bits64());
}

Bytes framed(Piece piece, const Bytes& payload) {
    ByteWriter out;
    out.byte(static_cast<std::uint8_t>(piece));
    out.number(payload.size());
    out.word(checksum(piece, payload.data(), payload.size()), 4);
    out.add(payload);
    return std::move(out.bytes());
}

Bytes packed_base(const std::vector<Cell>& cells, const Faces& faces) {
    std::vector<std::int64_t> numbers;
    for (int axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < cells.size(); ++i) numbers.push_back(cells[i][axis] - (i ? cells[i - 1][axis] : 0));
    Bytes out = packed(numbers, 4);
    numbers.clear();
    for (std::size_t i = 0; i < faces.size(); ++i)
        for (int k = 0; k < 3; ++k) numbers.push_back(faces[i][k] - (k ? faces[i][k - 1] : i ? faces[i - 1][0] : 0));
    const Bytes more = packed(numbers, 4);
    out.insert(out.end(), more.begin(), more.end());
    return out;
}

void unpack_base(ByteReader& in, const Header& header, std::vector<Cell>& cells, Faces& faces) {
    const auto n = static_cast<std::size_t>(header.base_vertices);
    std::vector<std::int64_t> numbers = unpacked(in, 3 * n, 4);
    cells.resize(n);
    const std::int64_t end = std::int64_t{1} << header.base_bits;
    for (int axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < n; ++i) {
            const std::int64_t x = numbers[axis * n + i] + (i ? cells[i - 1][axis] : 0);
            require(x >= 0 && x < end, "the stream is damaged: a place outside the box");
            cells[i][axis] = static_cast<std::int32_t>(x);
        }
    numbers = unpacked(in, 3 * static_cast<std::size_t>(header.base_faces), 4);
    faces.resize(header.base_faces);
    for (std::size_t i = 0; i < faces.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            const std::int64_t v = numbers[3 * i + k] + (k ? faces[i][k - 1] : i ? faces[i - 1][0] : 0);
            require(v >= 0 && v < header.base_vertices, "the stream is damaged: a face of no vertex");
            faces[i][k] = static_cast<Index>(v);
        }
}

}  // namespace multires::stream
