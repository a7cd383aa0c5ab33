#include "mesh/specks.h"

#include "base/disjoint_sets.h"

#include <algorithm>

namespace multires {
namespace {

/// Entries of the faces that stay.
template <class Values>
void keep(const std::vector<std::uint8_t>& stays, Values& of_faces) {
    if (of_faces.empty()) return;
    std::size_t to = 0;
    for (std::size_t f = 0; f < stays.size(); ++f)
        if (stays[f]) of_faces[to++] = of_faces[f];
    of_faces.resize(to);
}

}  // namespace

std::optional<WithoutSpecks> without_specks(const Layer& layer) {
    const Faces& faces = layer.mesh.faces;
    const auto vertices = static_cast<Index>(layer.mesh.positions.size());
    DisjointSets parts(vertices);
    for (const Face& f : faces)
        for (const Index v : {f[1], f[2]}) parts.join(f[0], v);
    Array<Index> size(vertices, 0);  // of the part whose root a vertex is
    for (Index v = 0; v < vertices; ++v) ++size[parts.find(v).root];
    const Index largest = vertices > 0 ? *std::max_element(size.begin(), size.end()) : 0;
    const auto goes = [&](Index root) { return size[root] > 1 && is_speck(size[root], largest); };

    WithoutSpecks out;
    for (Index v = 0; v < vertices; ++v) out.specks += goes(v);
    if (out.specks == 0) return std::nullopt;
    std::vector<std::uint8_t> stays(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) stays[f] = !goes(parts.find(faces[f][0]).root);
    out.layer = layer;
    out.layer.wedges.clear();
    keep(stays, out.layer.mesh.faces);
    keep(stays, out.layer.selected_face);
    keep(stays, out.layer.faux_edges);
    keep(stays, out.layer.selected_edges);
    return out;
}

}  // namespace multires
