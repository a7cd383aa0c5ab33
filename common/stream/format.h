#pragma once

#include "stream/bytes.h"
#include "stream/ordinals.h"
#include "stream/progress.h"

#include <string>
#include <vector>

/// The layout of the file, see docs/stream.md: a signature, and pieces of a kind, a size, a checksum and a payload.
namespace multires::stream {

/// Followed by a byte with the version.
constexpr std::uint8_t signature[7] = {0x89, 'M', 'R', 'M', '\r', '\n', 0x1a};
constexpr std::uint8_t newest_version = 3;
constexpr std::size_t most_attributes = 256;

enum class Piece : std::uint8_t {
    header = 'H',
    base = 'B',
    splits = 'S',
    refinement = 'R',
    attributes = 'A',
    wedges = 'W',
    exact = 'X',
    vertex_order = 'V',
    face_order = 'F',
    end = 'E',
};

/// What the header says.
struct Header {
    struct Column {
        AttributeKind kind = AttributeKind::scalar;
        std::string name;
        int width = 1;
        Storage storage = Storage::full;
        std::vector<std::int64_t> same;  ///< ordinals, if they are those of all vertices; else empty
    };
    std::uint64_t bytes = 0;  ///< of the whole file without signature and header
    Index vertices = 0, faces = 0, base_vertices = 0, base_faces = 0;
    int bits = 12, base_bits = 12;
    Vec3 origin{0, 0, 0};
    double step = 1;   ///< mesh units of a cell
    double bulge = 0;  ///< how much of the ring's height prefixes add to a vertex, see Decoder::layer()
    std::vector<Column> columns;

    void write(ByteWriter& out) const;
    /// @throws InputError  if the numbers cannot belong to a file of that size
    void read(ByteReader& in);

    /// The place of a cell.
    /// @param bits_less  by how much it is coarser than the finest ones
    Vec3 place(const Cell& cell, int bits_less) const;
};

/// A piece as it is in the file.
Bytes framed(Piece piece, const Bytes& payload);

/// The base's cells and faces.
Bytes packed_base(const std::vector<Cell>& cells, const Faces& faces);
void unpack_base(ByteReader& in, const Header& header, std::vector<Cell>& cells, Faces& faces);

/// First 32 bits of the XXH3 of a piece.
std::uint32_t checksum(Piece piece, const std::uint8_t* payload, std::size_t size);

}  // namespace multires::stream
