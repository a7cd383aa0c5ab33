#include "stream/decoder.h"

#include "base/error.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace multires::stream {
namespace {

/// A permutation of `count` numbers, as differences to earlier ones.
/// @param like  which one each is like
template <class Like>
std::vector<Index> unpacked_order(ByteReader& in, std::size_t count, const Like& like) {
    const std::vector<std::int64_t> numbers = unpacked(in, count, 4);
    std::vector<Index> out(count);
    std::vector<std::uint8_t> seen(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        const std::int64_t x = numbers[i] + (i ? out[like(i)] : 0);
        require(x >= 0 && x < static_cast<std::int64_t>(count) && !seen[x], "the stream is damaged: an order is none");
        seen[x] = 1;
        out[i] = static_cast<Index>(x);
    }
    return out;
}

std::vector<std::uint8_t> unpacked_turns(ByteReader& in, std::size_t count) {
    std::vector<std::uint8_t> out(count);
    const std::vector<std::int64_t> turns = unpacked(in, count, 1);
    for (std::size_t i = 0; i < count; ++i) {
        require(turns[i] >= 0 && turns[i] < 3, "the stream is damaged: an order is none");
        out[i] = static_cast<std::uint8_t>(turns[i]);
    }
    return out;
}

}  // namespace

void Decoder::feed(const std::uint8_t* data, std::size_t size) {
    if (satisfied_ || finished()) return;
    buffer_.insert(buffer_.end(), data, data + size);
    while (!satisfied_ && !finished() && take_piece()) {
    }
    if (at_ > (1 << 16) && at_ > buffer_.size() / 2) {
        buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(at_));
        at_ = 0;
    }
}

/// @returns false if the next piece is not there as a whole
bool Decoder::take_piece() {
    const std::size_t there = buffer_.size() - at_;
    if (there == 0) return false;
    if (stage_ == Stage::signature) {
        const std::size_t n = sizeof signature;
        require(std::memcmp(buffer_.data(), signature, std::min(n, there)) == 0, "this is no .mrm file");
        if (there <= n) return false;
        require(buffer_[n] >= 1 && buffer_[n] <= newest_version,
                "this .mrm file is of a version that is not known here");
        version_ = buffer_[n];
        at_ = n + 1;
        stage_ = Stage::header;
        return true;
    }
    std::uint64_t size = 0;
    std::size_t head = 1;
    for (int shift = 0;; shift += 7, ++head) {
        if (head >= there) return false;
        const std::uint8_t b = buffer_[at_ + head];
        size |= static_cast<std::uint64_t>(b & 127) << shift;
        if (b < 128) break;
        require(shift < 42, "the stream is damaged: a piece's size");
    }
    head += 1 + 4;
    const std::uint64_t most =
        stage_ == Stage::header ? 1 << 20 : header_.bytes - std::min<std::uint64_t>(taken_, header_.bytes);
    require(size <= most, "the stream is damaged: a piece is larger than the file");
    if (there < head + size) return false;
    const auto piece = static_cast<Piece>(buffer_[at_]);
    const std::uint8_t* const payload = buffer_.data() + at_ + head;
    const std::uint64_t wanted = ByteReader(payload - 4, 4).word(4);
    require(checksum(piece, payload, size) == wanted, "the stream is damaged: a checksum is wrong");
    at_ += head + size;
    if (stage_ != Stage::header) taken_ += head + size;
    take(piece, ByteReader(payload, size));
    return true;
}

void Decoder::take(Piece piece, ByteReader in) {
    if (stage_ == Stage::header) {
        require(piece == Piece::header, "the stream is damaged: it has no header");
        header_.read(in);
        columns_ = Columns(header_.columns);
        stage_ = Stage::base;
        return;
    }
    if (stage_ == Stage::base) {
        require(piece == Piece::base, "the stream is damaged: it has no base");
        take_base(in);
        return;
    }
    switch (piece) {
    case Piece::splits:
        take_splits(in);
        break;
    case Piece::refinement: {
        require(progress_->bits() < header_.bits && progress_->at_end_of_batch(),
                "the stream is damaged: it is finer than it says");
        BitCoder coder(in.rest(), in.left());
        progress_->refine(coder, nullptr);
        break;
    }
    case Piece::attributes:
        columns_.unpack(in, progress_->parents(), vertices());
        break;
    default:
        take_extra(piece, in);
    }
    if (piece != Piece::splits || columns_.empty()) check_limits();
}

void Decoder::take_base(ByteReader& in) {
    std::vector<Cell> cells;
    Faces faces;
    unpack_base(in, header_, cells, faces);
    progress_ = std::make_unique<Progress>(std::move(cells), faces, header_.base_bits, header_.vertices, version_);
    error_ = header_.step * (1 << header_.bits);
    stage_ = Stage::body;
    check_limits();
}

void Decoder::take_splits(ByteReader& in) {
    const std::uint64_t visits = in.number();
    const auto bits = static_cast<std::uint32_t>(in.word(2) << 16);
    float error = 0;
    std::memcpy(&error, &bits, sizeof error);
    BitCoder coder(in.rest(), in.left());
    for (std::uint64_t i = 0; i < visits; ++i) {
        if (limits_.vertices && vertices() >= *limits_.vertices) {
            satisfied_ = true;
            return;
        }
        progress_->visit(coder, nullptr);  // behind the code's end all decisions are yes: that ends soon
    }
    error_ = error;
}

/// What comes once the mesh is whole.
void Decoder::take_extra(Piece piece, ByteReader& in) {
    require(has_all(), "the stream is damaged: it ends before the mesh is whole");
    const auto n = static_cast<std::size_t>(header_.vertices), m = static_cast<std::size_t>(header_.faces);
    if (piece == Piece::end) {
        stage_ = Stage::ended;
        buffer_.clear();
        at_ = 0;
    } else if (piece == Piece::exact) {
        exact_ = unpacked_positions(in, header_, progress_->cells());
    } else if (piece == Piece::wedges) {
        wedges_ = unpacked_wedges(in, progress_->mesh());
    } else if (piece == Piece::vertex_order) {
        const std::vector<Index>& parents = progress_->parents();
        vertex_order_ = unpacked_order(
            in, n, [&](std::size_t v) { return parents[v] >= 0 ? static_cast<std::size_t>(parents[v]) : v - 1; });
    } else if (piece == Piece::face_order) {
        std::vector<Index> order = unpacked_order(in, m, [](std::size_t f) { return f - 1; });
        turn_ = unpacked_turns(in, m);
        face_order_ = std::move(order);
    } else {
        throw InputError("the stream is damaged: a piece of an unknown kind");
    }
}

bool Decoder::has_all() const {
    return started() && vertices() == header_.vertices && progress_->mesh().faces() == header_.faces &&
           progress_->bits() == header_.bits;
}

void Decoder::check_limits() {
    if (limits_.vertices && vertices() >= *limits_.vertices && vertices() < header_.vertices) satisfied_ = true;
    if (limits_.error && error_ <= *limits_.error && !has_all()) satisfied_ = true;
}

std::size_t Decoder::missing() const {
    if (finished()) return 0;
    return stage_ <= Stage::header
               ? 0
               : static_cast<std::size_t>(header_.bytes - std::min<std::uint64_t>(header_.bytes, taken_));
}

Layer Decoder::layer() const {
    require(started(), "there is no mesh yet");
    Layer out;
    const StarMesh& mesh = progress_->mesh();
    for (Index f = 0; f < mesh.faces(); ++f) out.mesh.faces.push_back(mesh.face(f));
    for (const Cell& c : progress_->cells())
        out.mesh.positions.push_back(header_.place(c, header_.bits - progress_->bits()));
    out.attributes = columns_.attributes(progress_->parents());
    if (exact_) out.mesh.positions = *exact_;
    if (!has_all()) {
        const Positions plain = out.mesh.positions;
        const double whole = header_.vertices, there = vertices();
        add_bulge(mesh, plain, header_.bulge * (1 - there / whole), out.mesh.positions);
    }
    out.wedges = wedges_;
    reorder(out);
    return out;
}

void Decoder::reorder(Layer& layer) const {
    if (!vertex_order_.empty()) {
        const Layer from = layer;
        for (std::size_t v = 0; v < vertex_order_.size(); ++v) {
            layer.mesh.positions[vertex_order_[v]] = from.mesh.positions[v];
            for (std::size_t k = 0; k < from.attributes.size(); ++k) {
                const int width = from.attributes[k].width;
                std::copy_n(&from.attributes[k].values[v * width], width,
                            &layer.attributes[k].values[static_cast<std::size_t>(vertex_order_[v]) * width]);
            }
        }
        for (Face& f : layer.mesh.faces)
            for (Index& v : f) v = vertex_order_[v];
    }
    if (face_order_.empty()) return;
    const Faces faces = layer.mesh.faces;
    const std::vector<Wedge> wedges = layer.wedges;
    for (std::size_t f = 0; f < face_order_.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const int to = (k + turn_[f]) % 3;
            layer.mesh.faces[face_order_[f]][to] = faces[f][k];
            if (!wedges.empty()) layer.wedges[3 * static_cast<std::size_t>(face_order_[f]) + to] = wedges[3 * f + k];
        }
}

Layer decode(const Bytes& bytes, const Limits& limits) {
    Decoder decoder(limits);
    decoder.feed(bytes.data(), bytes.size());
    require(decoder.started(), "the file ends before its first mesh");
    return decoder.layer();
}

}  // namespace multires::stream
