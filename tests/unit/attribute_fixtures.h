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

inline AttributeChoice everything() { return {true, true, true, true, true, ""}; }

inline Result relax(const Layer& layer, const AttributeRelaxationOptions& options) {
    Session session;
    return relax_attributes(layer, options, session);
}

inline double random_value(Index v, int k) {
    shapes::Random random(1000 * v + k + 1);
    return random.uniform(10, 240);
}

}  // namespace multires::fixtures
