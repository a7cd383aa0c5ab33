#include "filters/reopened.h"

#include "mesh/wedge_charts.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace multires {
namespace {

/// A vertex of the new layer. Where a chart has no value for a place its corner has moved to, it keeps the one it had.
struct Vertex {
    Index source;  ///< vertex of the layer
    Index made;    ///< vertex of the mesh made of the closed layer
    Index values;  ///< vertex of the layer whose attributes it has

    friend bool operator==(const Vertex& a, const Vertex& b) {
        return a.made == b.made && a.source == b.source && a.values == b.values;
    }
};

/// The vertices of the layer, each by itself.
JoinedVertices each_vertex(const Layer& layer) {
    JoinedVertices each;
    each.first.resize(layer.mesh.positions.size());
    std::iota(each.first.begin(), each.first.end(), 0);
    return each;
}

/// The vertices of the layer, those of a seam as one where all their values are the same.
JoinedVertices alike_vertices(const Layer& layer, const ClosedLayer& closed) {
    std::vector<std::size_t> attributes;
    for (std::size_t i = 0; i < layer.attributes.size(); ++i)
        if (layer.attributes[i].name != source_vertex_name) attributes.push_back(i);
    JoinedVertices alike = join_seams_where_alike(layer, closed.seams, attributes);
    return alike.first.empty() ? each_vertex(layer) : alike;
}

/// Two numbers by which the values of one place are told apart: texture coordinates, or else what comes first.
std::pair<double, double> key_values(const Layer& layer, Index v) {
    const Attribute* best = nullptr;
    for (const Attribute& a : layer.attributes)
        if (a.name != source_vertex_name && (!best || a.kind == AttributeKind::texcoord)) best = &a;
    if (!best) return {0, 0};
    const double* const row = best->values.data() + static_cast<std::size_t>(v) * best->width;
    return {row[0], best->width > 1 ? row[1] : 0};
}

/// Finds which of the vertices at a place a corner of a new face belongs to.
class Corners {
public:
    Corners(const Layer& layer, const ClosedLayer& closed, const DerivedMesh& mesh)
        : closed_(closed), mesh_(mesh),
          alike_(mesh.source_vertex.size() == closed.layer.mesh.positions.size() ? each_vertex(layer)
                                                                                 : alike_vertices(layer, closed)),
          faces_(layer.mesh.faces),
          charts_(static_cast<Index>(closed.layer.mesh.positions.size()), closed.layer.mesh.faces, wedges(layer)) {}

    /// The vertices of a new face.
    std::array<Vertex, 3> of(std::size_t face) const {
        const Face& f = mesh_.faces[face];
        const Index source = mesh_.source_face[face];
        const FacePair pair({mesh_.source_vertex[f[0]], mesh_.source_vertex[f[1]], mesh_.source_vertex[f[2]]},
                            closed_.layer.mesh.faces[source]);
        std::array<Vertex, 3> out{};
        for (int k = 0; k < 3; ++k) {
            const Index values = alike_.first[pair.moved(k) ? charts_.wedge(pair.now[k], source, pair.place(k)).texture
                                                            : alike_.of(faces_[source][pair.place(k)])];
            const bool there = closed_.seams.of(values) == pair.now[k];
            out[k] = {there ? values : closed_.seams.first[pair.now[k]], f[k], values};
        }
        return out;
    }

private:
    /// The vertices of the faces' corners, in place of textures: a chart is one of vertices that faces share.
    std::vector<Wedge> wedges(const Layer& layer) const {
        std::vector<Wedge> out;
        out.reserve(3 * layer.mesh.faces.size());
        for (const Face& f : layer.mesh.faces)
            for (const Index v : f) {
                const auto [a, b] = key_values(layer, alike_.first[alike_.of(v)]);
                out.push_back({a, b, alike_.of(v)});
            }
        return out;
    }

    const ClosedLayer& closed_;
    const DerivedMesh& mesh_;
    JoinedVertices alike_;
    const Faces& faces_;
    WedgeCharts charts_;
};

/// The vertices of the new layer, once each.
class Vertices {
public:
    Vertices(std::vector<Vertex> all, bool as_in_input) : as_in_input_(as_in_input), all_(std::move(all)) {
        std::sort(all_.begin(), all_.end(), [&](const Vertex& a, const Vertex& b) { return key(a) < key(b); });
        all_.erase(std::unique(all_.begin(), all_.end()), all_.end());
    }
    const std::vector<Vertex>& all() const { return all_; }
    Index number(const Vertex& v) const {
        const auto at = std::lower_bound(all_.begin(), all_.end(), v,
                                         [&](const Vertex& a, const Vertex& b) { return key(a) < key(b); });
        return static_cast<Index>(at - all_.begin());
    }

private:
    std::tuple<Index, Index, Index> key(const Vertex& v) const {
        return as_in_input_ ? std::tuple(v.source, v.made, v.values) : std::tuple(v.made, v.source, v.values);
    }

    bool as_in_input_;
    std::vector<Vertex> all_;
};

/// The vertices of all corners, and those that no face has.
std::vector<Vertex> vertices_of(const ClosedLayer& closed, const DerivedMesh& mesh,
                                const std::vector<std::array<Vertex, 3>>& faces) {
    std::vector<Vertex> all;
    std::vector<std::uint8_t> used(mesh.source_vertex.size(), 0);
    for (const std::array<Vertex, 3>& f : faces)
        for (const Vertex& v : f) all.push_back(v), used[v.made] = 1;
    for (std::size_t i = 0; i < used.size(); ++i) {
        const Index source = closed.seams.first[mesh.source_vertex[i]];
        if (!used[i]) all.push_back({source, static_cast<Index>(i), source});
    }
    return all;
}

/// Rows of `from`, one after the other.
Attribute rows_of(const Attribute& from, const std::vector<Vertex>& vertices, Index Vertex::*row) {
    Attribute out{from.kind, from.name, from.width, {}};
    for (const Vertex& v : vertices) {
        const auto begin = from.values.begin() + static_cast<std::ptrdiff_t>(v.*row) * from.width;
        out.values.insert(out.values.end(), begin, begin + from.width);
    }
    return out;
}

}  // namespace

DerivedMesh reopened(const Layer& layer, const ClosedLayer& closed, DerivedMesh mesh) {
    const Corners corners(layer, closed, mesh);
    std::vector<std::array<Vertex, 3>> faces(mesh.faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = corners.of(f);
    const Vertices vertices(vertices_of(closed, mesh, faces),
                            std::is_sorted(mesh.source_vertex.begin(), mesh.source_vertex.end()));
    const std::vector<Vertex>& all = vertices.all();
    DerivedMesh out;
    out.name = std::move(mesh.name);
    out.source_face = std::move(mesh.source_face);
    for (const Vertex& v : all) out.source_vertex.push_back(v.source);
    for (const std::array<Vertex, 3>& f : faces)
        out.faces.push_back({vertices.number(f[0]), vertices.number(f[1]), vertices.number(f[2])});
    if (mesh.positions) {
        out.positions.emplace();
        for (const Vertex& v : all) out.positions->push_back((*mesh.positions)[v.made]);
    }
    for (const Attribute& a : mesh.attributes) out.attributes.push_back(rows_of(a, all, &Vertex::made));
    const bool elsewhere = std::any_of(all.begin(), all.end(), [](const Vertex& v) { return v.values != v.source; });
    if (elsewhere && mesh.attributes.empty())
        for (const Attribute& a : layer.attributes)
            if (a.name != source_vertex_name) out.attributes.push_back(rows_of(a, all, &Vertex::values));
    return out;
}

}  // namespace multires
