#pragma once

#include "filters/attributes/attributes.h"

#include "fixtures.h"
#include "reported.h"

#include <string>

/// What the tests of attribute relaxation share: layers with every kind of attribute.
namespace multires::fixtures {

/// An attribute with value(vertex, channel).
template <class F>
Attribute attribute(const Mesh& mesh, AttributeKind kind, int width, const F& value, const std::string& name = "") {
    Attribute a{kind, name, width, {}};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        for (int k = 0; k < width; ++k) a.values.push_back(value(static_cast<Index>(i), k));
    return a;
}

/// Every kind of attribute, all of them `value`.
template <class F>
Layer with_everything(Mesh mesh, const F& value) {
    Layer layer;
    layer.mesh = std::move(mesh);
    layer.attributes = {attribute(layer.mesh, AttributeKind::color, 4, value),
                        attribute(layer.mesh, AttributeKind::quality, 1, value),
                        attribute(layer.mesh, AttributeKind::texcoord, 2, value),
                        attribute(layer.mesh, AttributeKind::scalar, 1, value, "heat"),
                        attribute(layer.mesh, AttributeKind::point, 3, value, "flow")};
    for (const Face& f : layer.mesh.faces)
        for (const Index v : f) layer.wedges.push_back({value(v, 0), value(v, 1), 0});
    return layer;
}

inline double random_value(Index v, int k) {
    shapes::Random random(1000 * v + k + 1);
    return random.uniform(10, 240);
}

/// The layer with half of it selected, some edges selected and most edges faux: no choice that a filter offers lacks
/// what it works on.
inline Layer marked(Layer layer) {
    const Faces& faces = layer.mesh.faces;
    layer.selected_vertex.assign(layer.mesh.positions.size(), 0);
    layer.selected_face.assign(faces.size(), 0);
    std::fill_n(layer.selected_vertex.begin(), (layer.selected_vertex.size() + 1) / 2, std::uint8_t{1});
    std::fill_n(layer.selected_face.begin(), (faces.size() + 1) / 2, std::uint8_t{1});
    layer.faux_edges.assign(faces.size(), 0);
    layer.selected_edges.assign(faces.size(), 0);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Index ends = faces[f][k] + faces[f][(k + 1) % 3];  // the same for both faces of the edge
            if (ends % 9 != 0) layer.faux_edges[f] |= 1 << k;
            if (ends % 11 == 0) layer.selected_edges[f] |= 1 << k;
        }
    return layer;
}

/// True for errors about a combination of parameters that no mesh can help; all others are the mesh's.
inline bool blames_parameters(const std::string& error) {
    for (const char* part : {"no attribute is chosen", "at least one kind of detail", "form: ", "threshold_unit share",
                             "use: there is no attribute", "scheme: ", "features: the scheme"})
        if (error.find(part) != std::string::npos) return true;
    return false;
}

inline AttributeChoice everything() { return {true, true, true, true, true, ""}; }

inline Result relax(const Layer& layer, const AttributeRelaxationOptions& options) {
    Session session;
    return relax_attributes(layer, options, session);
}

}  // namespace multires::fixtures
