#pragma once

#include "shared/bindings.h"

#include "filters/channels.h"

/// Bindings of the choice of attributes, for the filters that work on them.
namespace multires::plugin {

inline const char* const attribute_group = "Attributes";

inline void bind_linear_light(Parameters& p, bool& linear_light) {
    p.add("linear_light", &linear_light, "Colours as light",
          "Decode colours (sRGB) to amounts of light before computing with them, and encode the result. Right for "
          "photographs; off, colours are computed with as they are stored, right for colour scales.")
        .advanced(attribute_group);
}

inline void bind_color_and_quality(Parameters& p, AttributeChoice& what) {
    p.add("color", &what.color, "Vertex colour", "With alpha.").in(attribute_group).derived();
    p.add("quality", &what.quality, "Vertex quality", "The scalar value of the vertices.")
        .in(attribute_group)
        .derived();
}

/// To be followed by bind_custom_names.
inline Parameter& bind_custom(Parameters& p, AttributeChoice& what) {
    return p.add("custom", &what.custom, "Custom attributes", "Custom scalars and points of the vertices.")
        .in(attribute_group);
}

inline void bind_custom_names(Parameters& p, AttributeChoice& what) {
    p.add("custom_names", &what.custom_names, "Names of custom attributes",
          "Which custom attributes: their names, separated by commas. Empty: all, but for source_vertex.")
        .in(attribute_group);
}

}  // namespace multires::plugin
