#include "filters/layers/texture_seams.h"

#include <algorithm>
#include <tuple>

namespace multires {

TextureSeams texture_seams(const Layer& layer) {
    struct Side {
        Index low, high, face;
        int k;
    };
    std::vector<Side> sides;
    sides.reserve(3 * layer.mesh.faces.size());
    const Faces& faces = layer.mesh.faces;
    const std::vector<Wedge>& corner = corner_texcoords(layer);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(faces[f][k], faces[f][(k + 1) % 3]);
            sides.push_back({low, high, static_cast<Index>(f), k});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.face, a.k) < std::tie(b.low, b.high, b.face, b.k);
    });
    const auto wedge = [&](const Side& s, Index vertex) {
        const Wedge& w = corner[3 * s.face + (faces[s.face][s.k] == vertex ? s.k : (s.k + 1) % 3)];
        return std::make_tuple(w.u, w.v, w.texture);
    };
    const auto apex = [&](const Side& s) { return faces[s.face][(s.k + 2) % 3]; };
    TextureSeams seams;
    seams.edges.assign(faces.size(), 0);
    std::vector<Index> edges_at(layer.mesh.positions.size(), 0);
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        const Side& first = sides[begin];
        while (end < sides.size() && sides[end].low == first.low && sides[end].high == first.high) ++end;
        const auto differs = [&](const Side& a) {
            bool across = false;
            for (std::size_t i = begin; i < end; ++i) {
                if (apex(sides[i]) == apex(a)) continue;
                if (wedge(a, a.low) == wedge(sides[i], a.low) && wedge(a, a.high) == wedge(sides[i], a.high))
                    return false;
                across = true;
            }
            return across;
        };
        const auto at = [&](std::size_t i) { return sides.begin() + static_cast<std::ptrdiff_t>(i); };
        if (std::none_of(at(begin), at(end), differs)) continue;
        for (std::size_t i = begin; i < end; ++i) seams.edges[sides[i].face] |= 1 << sides[i].k;
        ++edges_at[first.low], ++edges_at[first.high];
    }
    const auto many = [](Index edges) { return edges > 2; };
    seams.junctions = static_cast<Index>(std::count_if(edges_at.begin(), edges_at.end(), many));
    return seams;
}

bool can_keep_seams(const Layer& layer) {
    if (corner_texcoords(layer).empty()) return false;
    return 20 * texture_seams(layer).junctions <= static_cast<Index>(layer.mesh.positions.size());
}

}  // namespace multires
