#pragma once

#include "mesh/layer.h"
#include "stream/columns.h"
#include "stream/format.h"
#include "stream/progress.h"

#include <memory>
#include <optional>

namespace multires::stream {

/// Where to stop reading.
struct Limits {
    std::optional<Index> vertices;  ///< as soon as there are so many, or one or two more
    std::optional<double> error;    ///< as soon as error() is at most this, mesh units
};

/// Decodes a file as its bytes arrive; there is a mesh once a few hundred have, and a better one after every piece.
class Decoder {
public:
    explicit Decoder(const Limits& limits = {}) : limits_(limits) {}

    /// Takes the next bytes and decodes the pieces that are complete.
    /// @throws InputError  if they are damaged; what was decoded before stays
    void feed(const std::uint8_t* data, std::size_t size);

    bool started() const { return progress_ != nullptr; }     ///< there is a mesh
    bool finished() const { return stage_ == Stage::ended; }  ///< all has been read
    bool satisfied() const { return satisfied_; }             ///< a limit has been reached: more bytes are ignored
    const Header& header() const { return header_; }          ///< once there is a mesh
    Index vertices() const { return progress_ ? progress_->mesh().vertices() : 0; }
    /// The encoder's estimate of the RMS distance of the whole mesh's vertices from the present mesh, mesh units.
    double error() const { return error_; }
    bool is_exact() const { return exact_.has_value(); }         ///< positions are bit for bit what they were
    bool keeps_order() const { return !vertex_order_.empty(); }  ///< vertices and faces are in the order of the input
    /// How many bytes of the file have not come yet; only known once there is a header.
    std::size_t missing() const;

    /// The present mesh, with attributes; complete, it is the mesh that was encoded.
    ///
    /// A mesh whose vertices lie on a curved surface lies inside of it. Prefixes make up for that: a vertex goes
    /// outwards by the share Header::bulge of its height over its ring, 1/4 being what halves the sum of squares on a
    /// quadric.
    Layer layer() const;

private:
    enum class Stage { signature, header, base, body, ended };

    bool take_piece();
    void take(Piece piece, ByteReader in);
    void take_base(ByteReader& in);
    void take_splits(ByteReader& in);
    void take_extra(Piece piece, ByteReader& in);
    bool has_all() const;
    void check_limits();
    void reorder(Layer& layer) const;

    Limits limits_;
    Stage stage_ = Stage::signature;
    bool satisfied_ = false;
    Bytes buffer_;
    std::size_t at_ = 0, taken_ = 0;
    int version_ = newest_version;
    Header header_;
    std::unique_ptr<Progress> progress_;
    Columns columns_;
    double error_ = 0;
    std::optional<Positions> exact_;
    std::vector<Wedge> wedges_;
    std::vector<Index> vertex_order_, face_order_;  ///< of the input, by the stream's; empty: not kept
    std::vector<std::uint8_t> turn_;
};

/// Decodes a whole file or the begin of one.
/// @throws InputError  if it is damaged, or so short that there is no mesh (the message says how many bytes are
/// missing)
Layer decode(const Bytes& bytes, const Limits& limits = {});

}  // namespace multires::stream
