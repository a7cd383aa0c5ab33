#include "mesh/seams.h"

#include "base/disjoint_sets.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

namespace multires {
namespace {

/// Vertices around which the faces do not close: the next and the previous corners of their faces differ, by the sum of
/// a hash. Of faces that disagree in orientation there are more.
std::vector<Index> open_vertices(const Mesh& mesh) {
    std::vector<std::uint64_t> sum(mesh.positions.size(), 0);
    const auto hash = [](Index v) { return (static_cast<std::uint64_t>(v) + 1) * 0x9e3779b97f4a7c15U; };
    for (const Face& f : mesh.faces)
        for (int k = 0; k < 3; ++k) sum[f[k]] += hash(f[(k + 1) % 3]) - hash(f[(k + 2) % 3]);
    std::vector<Index> open;
    for (std::size_t v = 0; v < sum.size(); ++v)
        if (sum[v] != 0 && mesh.positions[v].allFinite()) open.push_back(static_cast<Index>(v));
    return open;
}

/// #V: the number of its place for open vertices that are not alone there, -1 for all others; empty if all are alone.
std::vector<Index> shared_places(const Mesh& mesh) {
    std::vector<Index> open = open_vertices(mesh);
    const auto place = [&](Index v) {
        const Vec3& p = mesh.positions[v];
        return std::tuple(p.x(), p.y(), p.z());
    };
    std::sort(open.begin(), open.end(),
              [&](Index a, Index b) { return std::pair(place(a), a) < std::pair(place(b), b); });
    std::vector<Index> out;
    Index count = 0;
    for (std::size_t i = 0, end = 0; i < open.size(); i = end) {
        while (end < open.size() && place(open[end]) == place(open[i])) ++end;
        if (end - i < 2) continue;
        if (out.empty()) out.assign(mesh.positions.size(), -1);
        for (std::size_t k = i; k < end; ++k) out[open[k]] = count;
        ++count;
    }
    return out;
}

/// An edge of a face whose ends share their places with others.
struct Side {
    Index low, high;  ///< places
    Index from, to;   ///< vertices, as the face passes them
    Index face;
    bool up;  ///< from the lower place to the higher one

    friend bool operator<(const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.face, a.from) < std::tie(b.low, b.high, b.face, b.from);
    }
};

std::vector<Side> sides_of(const Mesh& mesh, const std::vector<Index>& place) {
    std::vector<Side> sides;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Index from = mesh.faces[f][k], to = mesh.faces[f][(k + 1) % 3];
            const Index a = place[from], b = place[to];
            if (a < 0 || b < 0 || a == b) continue;
            sides.push_back({std::min(a, b), std::max(a, b), from, to, static_cast<Index>(f), a < b});
        }
    std::sort(sides.begin(), sides.end());
    return sides;
}

bool folds_back(const Mesh& mesh, Index f, Index g) {
    constexpr double back = -0.866;  // cosine of 150 degrees
    const auto normal = [&](Index face) {
        const auto& [a, b, c] = mesh.faces[face];
        const Vec3& p = mesh.positions[a];
        return Vec3((mesh.positions[b] - p).cross(mesh.positions[c] - p).stableNormalized());
    };
    return normal(f).dot(normal(g)) < back;
}

/// @param alike  bool(Index, Index): whether two vertices may become one
template <class Alike>
JoinedVertices joined(const Mesh& mesh, const Alike& alike) {
    const std::vector<Index> place = shared_places(mesh);
    if (place.empty()) return {};
    const std::vector<Side> sides = sides_of(mesh, place);
    DisjointSets sets(static_cast<Index>(mesh.positions.size()));
    bool any = false;
    for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
        while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
        if (end - i != 2) continue;
        const Side &a = sides[i], &b = sides[i + 1];
        if (a.up == b.up || (a.from == b.to && a.to == b.from) || folds_back(mesh, a.face, b.face)) continue;
        if (!alike(a.from, b.to) || !alike(a.to, b.from)) continue;
        sets.join(a.from, b.to), sets.join(a.to, b.from);
        any = true;
    }
    if (!any) return {};
    JoinedVertices out;
    out.joined.assign(mesh.positions.size(), -1);
    std::vector<Index> of_root(mesh.positions.size(), -1);
    for (std::size_t v = 0; v < out.joined.size(); ++v) {
        Index& number = of_root[sets.find(static_cast<Index>(v)).root];
        if (number < 0) {
            number = static_cast<Index>(out.first.size());
            out.first.push_back(static_cast<Index>(v));
        }
        out.joined[v] = number;
    }
    return out;
}

}  // namespace

JoinedVertices join_seams(const Mesh& mesh) {
    return joined(mesh, [](Index, Index) { return true; });
}

JoinedVertices join_seams_where_alike(const Layer& layer, const JoinedVertices& seams,
                                      const std::vector<std::size_t>& attributes) {
    const auto alike = [&](Index a, Index b) {
        return std::all_of(attributes.begin(), attributes.end(), [&](std::size_t i) {
            const Attribute& of = layer.attributes[i];
            const double* const values = of.values.data();
            return std::equal(values + a * std::size_t(of.width), values + (a + 1) * std::size_t(of.width),
                              values + b * std::size_t(of.width));
        });
    };
    bool all = true;
    for (std::size_t v = 0; v < seams.joined.size() && all; ++v)
        all = alike(static_cast<Index>(v), seams.first[seams.joined[v]]);
    return all ? seams : joined(layer.mesh, alike);
}

}  // namespace multires
