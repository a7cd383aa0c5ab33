#include "stream/columns.h"

#include <algorithm>
#include <numeric>

namespace multires::stream {
namespace {

/// A face turned so that its smallest index comes first.
Face canonical(Face f) {
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    return f;
}

template <class FaceOf>
std::vector<Index> sorted_faces(Index count, const FaceOf& face) {
    std::vector<Index> order(count);
    std::iota(order.begin(), order.end(), 0);
    std::vector<Face> key(count);
    for (Index f = 0; f < count; ++f) key[f] = canonical(face(f));
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return key[a] < key[b]; });
    return order;
}

/// The ordinals of the first vertex, if all others have the same; else none.
std::vector<std::int64_t> same_of(const Attribute& a, Storage storage) {
    std::vector<std::int64_t> out;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const std::int64_t x = ordinal(a.values[i], storage);
        if (i < static_cast<std::size_t>(a.width))
            out.push_back(x);
        else if (x != out[i % a.width])
            return {};
    }
    return out;
}

Storage read_storage(ByteReader& in) {
    const int s = in.byte();
    require(s == 1 || s == 4 || s == 8, "the stream is damaged: how numbers are stored");
    return static_cast<Storage>(s);
}

}  // namespace

Columns::Columns(std::vector<Header::Column> columns) : columns_(std::move(columns)), value_(columns_.size()) {}

std::vector<Header::Column> Columns::describe(const std::vector<Attribute>& attributes) {
    require(attributes.size() <= most_attributes, "the mesh has more than 256 attributes");
    std::vector<Header::Column> out;
    for (const Attribute& a : attributes) {
        require(a.width >= 1 && a.width <= 4, "an attribute has more than four numbers a vertex");
        const Storage storage = storage_of(a.values);
        out.push_back({a.kind, a.name, a.width, storage, same_of(a, storage)});
    }
    return out;
}

bool Columns::empty() const {
    return std::all_of(columns_.begin(), columns_.end(), [](const Header::Column& c) { return !c.same.empty(); });
}

std::int64_t Columns::guess(std::size_t column, Index v, int c, const std::vector<Index>& parents) const {
    const Index like = parents[v] >= 0 ? parents[v] : v - 1;
    return like >= 0 ? value_[column][static_cast<std::size_t>(like) * columns_[column].width + c] : 0;
}

Bytes Columns::pack(const std::vector<Attribute>& attributes, const std::vector<Index>& source,
                    const std::vector<Index>& parents, Index until) {
    ByteWriter out;
    out.number(until - known_);
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (!varies(k)) continue;
        const int width = columns_[k].width;
        std::vector<std::int64_t> differences;
        for (Index v = known_; v < until; ++v)
            for (int c = 0; c < width; ++c) {
                const double x = attributes[k].values[static_cast<std::size_t>(source[v]) * width + c];
                const std::int64_t value = ordinal(x, columns_[k].storage);
                differences.push_back(static_cast<std::int64_t>(static_cast<std::uint64_t>(value) -
                                                                static_cast<std::uint64_t>(guess(k, v, c, parents))));
                value_[k].push_back(value);
            }
        out.add(packed(differences, width_of(columns_[k].storage)));
    }
    known_ = until;
    return std::move(out.bytes());
}

void Columns::unpack(ByteReader& in, const std::vector<Index>& parents, Index until) {
    const auto count = static_cast<Index>(in.number_up_to(until - known_));
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (!varies(k)) continue;
        const int width = columns_[k].width;
        const std::vector<std::int64_t> differences =
            unpacked(in, static_cast<std::size_t>(count) * width, width_of(columns_[k].storage));
        std::size_t at = 0;
        for (Index v = known_; v < known_ + count; ++v)
            for (int c = 0; c < width; ++c)
                value_[k].push_back(static_cast<std::int64_t>(static_cast<std::uint64_t>(differences[at++]) +
                                                              static_cast<std::uint64_t>(guess(k, v, c, parents))));
    }
    known_ += count;
}

std::vector<Attribute> Columns::attributes(const std::vector<Index>& parents) const {
    std::vector<Attribute> out;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        const auto& [kind, name, width, storage, same] = columns_[k];
        Attribute a{kind, name, width, {}};
        a.values.resize(parents.size() * width);
        for (Index v = 0; v < static_cast<Index>(parents.size()); ++v)
            for (int c = 0; c < width; ++c) {
                const std::size_t at = static_cast<std::size_t>(v) * width + c;
                if (!same.empty())
                    a.values[at] = real(same[c], storage);
                else if (v < known_)
                    a.values[at] = real(value_[k][at], storage);
                else if (parents[v] >= 0)
                    a.values[at] = a.values[static_cast<std::size_t>(parents[v]) * width + c];
            }
        out.push_back(std::move(a));
    }
    return out;
}

std::vector<FaceMatch> match_faces(const StarMesh& mesh, const std::vector<Index>& source, const Faces& input) {
    const auto of_stream = [&](Index f) {
        const Face face = mesh.face(f);
        return Face{source[face[0]], source[face[1]], source[face[2]]};
    };
    const std::vector<Index> here = sorted_faces(mesh.faces(), of_stream);
    const std::vector<Index> there = sorted_faces(static_cast<Index>(input.size()), [&](Index f) { return input[f]; });
    std::vector<FaceMatch> out(here.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
        const Face f = of_stream(here[i]);
        const Face& g = input[there[i]];
        FaceMatch match{there[i], 0};
        const auto differs = [&] {
            return f[0] != g[match.turn] || f[1] != g[(match.turn + 1) % 3] || f[2] != g[(match.turn + 2) % 3];
        };
        while (match.turn < 2 && differs()) ++match.turn;
        out[here[i]] = match;
    }
    return out;
}

Bytes packed_wedges(const StarMesh& mesh, const std::vector<FaceMatch>& match, const std::vector<Wedge>& wedges) {
    Array<double> all;
    for (const Wedge& w : wedges) all.push_back(w.u), all.push_back(w.v);
    const Storage s = std::max(Storage::single, storage_of(all));
    std::vector<std::int64_t> numbers, last(2 * static_cast<std::size_t>(mesh.vertices()), ordinal(0, s)), textures;
    int texture = 0;
    for (Index f = 0; f < mesh.faces(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Wedge& w = wedges[3 * static_cast<std::size_t>(match[f].face) + (k + match[f].turn) % 3];
            const std::size_t at = 2 * static_cast<std::size_t>(mesh.face(f)[k]);
            for (int c = 0; c < 2; ++c) {
                const std::int64_t x = ordinal(c == 0 ? w.u : w.v, s);
                numbers.push_back(static_cast<std::int64_t>(static_cast<std::uint64_t>(x) -
                                                            static_cast<std::uint64_t>(last[at + c])));
                last[at + c] = x;
            }
            textures.push_back(static_cast<std::int64_t>(w.texture) - texture);
            texture = w.texture;
        }
    ByteWriter out;
    out.byte(static_cast<std::uint8_t>(s));
    out.add(packed(numbers, width_of(s)));
    out.add(packed(textures, 4));
    return std::move(out.bytes());
}

std::vector<Wedge> unpacked_wedges(ByteReader& in, const StarMesh& mesh) {
    const Storage s = read_storage(in);
    const std::size_t corners = 3 * static_cast<std::size_t>(mesh.faces());
    const std::vector<std::int64_t> numbers = unpacked(in, 2 * corners, width_of(s));
    const std::vector<std::int64_t> textures = unpacked(in, corners, 4);
    std::vector<std::int64_t> last(2 * static_cast<std::size_t>(mesh.vertices()), ordinal(0, s));
    std::vector<Wedge> out(corners);
    std::int64_t texture = 0;
    for (std::size_t i = 0; i < corners; ++i) {
        const std::size_t at = 2 * static_cast<std::size_t>(mesh.face(static_cast<Index>(i / 3))[i % 3]);
        for (int c = 0; c < 2; ++c)
            last[at + c] = static_cast<std::int64_t>(static_cast<std::uint64_t>(last[at + c]) +
                                                     static_cast<std::uint64_t>(numbers[2 * i + c]));
        texture += textures[i];
        out[i] = {real(last[at], s), real(last[at + 1], s), static_cast<int>(texture)};
    }
    return out;
}

Bytes packed_positions(const Header& header, const std::vector<Cell>& cells, const std::vector<Index>& source,
                       const Positions& positions) {
    Array<double> all;
    for (const Vec3& p : positions) all.insert(all.end(), p.data(), p.data() + 3);
    const Storage s = std::max(Storage::single, storage_of(all));
    std::vector<std::int64_t> numbers;
    for (int axis = 0; axis < 3; ++axis)
        for (std::size_t v = 0; v < cells.size(); ++v)
            numbers.push_back(
                static_cast<std::int64_t>(static_cast<std::uint64_t>(ordinal(positions[source[v]][axis], s)) -
                                          static_cast<std::uint64_t>(ordinal(header.place(cells[v], 0)[axis], s))));
    ByteWriter out;
    out.byte(static_cast<std::uint8_t>(s));
    out.add(packed(numbers, width_of(s)));
    return std::move(out.bytes());
}

Positions unpacked_positions(ByteReader& in, const Header& header, const std::vector<Cell>& cells) {
    const Storage s = read_storage(in);
    const std::vector<std::int64_t> numbers = unpacked(in, 3 * cells.size(), width_of(s));
    Positions out(cells.size());
    for (int axis = 0; axis < 3; ++axis)
        for (std::size_t v = 0; v < cells.size(); ++v)
            out[v][axis] =
                real(static_cast<std::int64_t>(static_cast<std::uint64_t>(numbers[axis * cells.size() + v]) +
                                               static_cast<std::uint64_t>(ordinal(header.place(cells[v], 0)[axis], s))),
                     s);
    return out;
}

}  // namespace multires::stream
