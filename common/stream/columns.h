#pragma once

#include "stream/format.h"

#include <vector>

namespace multires::stream {

/// The attributes of vertices, as ordinals, in order of the stream; predicted by the vertex each was split off.
class Columns {
public:
    Columns() = default;
    explicit Columns(std::vector<Header::Column> columns);

    /// Describes the attributes of a layer. @throws InputError  for widths and numbers of them that the format has not
    static std::vector<Header::Column> describe(const std::vector<Attribute>& attributes);

    /// Vertices `known()` to `until - 1`, which are appended.
    /// @param parents  #V, -1 in the base
    Bytes pack(const std::vector<Attribute>& attributes, const std::vector<Index>& source,
               const std::vector<Index>& parents, Index until);
    void unpack(ByteReader& in, const std::vector<Index>& parents, Index until);

    Index known() const { return known_; }
    /// True if no vertex has anything of its own.
    bool empty() const;
    /// All of them for the vertices there are; those not known yet are like their parents.
    std::vector<Attribute> attributes(const std::vector<Index>& parents) const;

private:
    bool varies(std::size_t column) const { return columns_[column].same.empty(); }
    std::int64_t guess(std::size_t column, Index v, int c, const std::vector<Index>& parents) const;

    std::vector<Header::Column> columns_;
    std::vector<std::vector<std::int64_t>> value_;  ///< of each column: #V by width
    Index known_ = 0;
};

/// Which face of the input each face of the stream is, and by how many corners it is turned: corner k of the one is
/// corner (k + turn) mod 3 of the other.
struct FaceMatch {
    Index face = 0;
    int turn = 0;
};
/// @param source  input vertex of each of the stream's
/// Cost: sorting.
std::vector<FaceMatch> match_faces(const StarMesh& mesh, const std::vector<Index>& source, const Faces& input);

/// Texture coordinates of the corners, in order of the stream's faces; predicted by the last ones at the same vertex.
Bytes packed_wedges(const StarMesh& mesh, const std::vector<FaceMatch>& match, const std::vector<Wedge>& wedges);
std::vector<Wedge> unpacked_wedges(ByteReader& in, const StarMesh& mesh);

/// Positions, bit for bit, as differences to what cells say.
/// @param source  input vertex of each of the stream's
Bytes packed_positions(const Header& header, const std::vector<Cell>& cells, const std::vector<Index>& source,
                       const Positions& positions);
Positions unpacked_positions(ByteReader& in, const Header& header, const std::vector<Cell>& cells);

}  // namespace multires::stream
