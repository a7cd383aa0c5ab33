#pragma once

#include "shared/bindings.h"

#include "filters/attributes/channels.h"

/// Bindings of the choice of attributes, for the filters that work on them.
namespace multires::plugin {

inline const char* const attribute_group = "Attributes";

inline void bind_linear_light(Parameters& p, bool& linear_light) {
    p.boolean("linear_light", linear_light,
              {"Colours as light",
               "Decode colours (sRGB) to amounts of light before computing with them, and encode the result. Right for "
               "photographs; off, colours are computed with as they are stored, right for colour scales.",
               0, 1, true, attribute_group});
}

inline void bind_color_and_quality(Parameters& p, AttributeChoice& what) {
    p.boolean("color", what.color, {"Vertex colour", "With alpha.", 0, 1, false, attribute_group});
    p.boolean("quality", what.quality,
              {"Vertex quality", "The scalar value of the vertices.", 0, 1, false, attribute_group});
}

inline const Hint custom_names_hint{"Names of custom attributes",
                                    "Which custom attributes: their names, separated by commas. Empty: all, but for "
                                    "source_vertex.",
                                    0,
                                    1,
                                    false,
                                    attribute_group};

inline void bind_custom(Parameters& p, AttributeChoice& what) {
    p.boolean("custom", what.custom,
              {"Custom attributes", "Custom scalars and points of the vertices.", 0, 1, false, attribute_group});
    p.text("custom_names", what.custom_names, custom_names_hint);
}

}  // namespace multires::plugin
