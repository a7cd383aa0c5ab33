#include "bindings.h"

#include "filters/attributes.h"

// Filters that work on attributes of the surface and leave its shape alone.

namespace multires::plugin {
namespace {

const char* const group = "Attributes";

void bind_linear_light(Parameters& p, bool& linear_light) {
    p.boolean("linear_light", linear_light,
              {"Colours as light",
               "Decode colours (sRGB) to amounts of light before computing with them, and encode the result. Right for "
               "photographs; off, colours are computed with as they are stored, right for colour scales.",
               0, 1, true, group});
}

void bind_color_and_quality(Parameters& p, AttributeChoice& what) {
    p.boolean("color", what.color, {"Vertex colour", "With alpha.", 0, 1, false, group});
    p.boolean("quality", what.quality, {"Vertex quality", "The scalar value of the vertices.", 0, 1, false, group});
}

void bind_custom(Parameters& p, AttributeChoice& what) {
    p.boolean("custom", what.custom,
              {"Custom attributes", "Custom scalars and points of the vertices.", 0, 1, false, group});
    p.text("custom_names", what.custom_names,
           {"Names of custom attributes",
            "Which custom attributes: their names, separated by commas. Empty: all, but for source_vertex.", 0, 1,
            false, group});
}

AttributeRelaxationOptions relaxation_defaults(const Layer* layer) {
    AttributeRelaxationOptions o;
    o.what = default_choice(layer);
    o.region.selected = has_selection(layer);
    return o;
}

void bind_relaxation(Parameters& p, AttributeRelaxationOptions& o) {
    bind_color_and_quality(p, o.what);
    p.boolean("texcoord", o.what.texcoord, {"Vertex texture coordinates", "Of the vertices.", 0, 1, false, group});
    p.boolean("wedge_texcoord", o.what.wedge_texcoord,
              {"Wedge texture coordinates",
               "Of the faces' corners, chart by chart: corners with the same vertex and the same texture coordinate "
               "stay together.",
               0, 1, false, group});
    bind_custom(p, o.what);
    p.integer("iterations", o.iterations,
              {"Iterations", "Steps of relaxation; each reaches a ring further.", 1, 10000, false, "Relaxation"});
    p.real("strength", o.strength,
           {"Strength", "Share of each step that is taken: 1 replaces a value by the mean around it.", 1e-6, 1, false,
            "Relaxation"});
    p.choice("operator", o.op, operator_names,
             {"Relaxation operator",
              "Weights of the neighbours, from the geometry. Delaunay cotangents: means in the strict sense, that keep "
              "linear functions on planes. Cotangents: those of the paper, which may be negative on bad triangles. The "
              "umbrella ignores geometry.",
              0, 5, true, "Relaxation"});
    p.real("corner_angle", o.corner_angle,
           {"Corner angle", "Degrees: where the boundary turns by more than this, values are kept.", 0, 180, true,
            "Relaxation"});
    p.boolean("keep_outline", o.keep_outline,
              {"Keep outlines of texture charts",
               "Keep texture coordinates on seams and boundaries as they are, so that charts keep their outline in the "
               "picture. Off: they are relaxed along the outline, both sides of a seam alike.",
               0, 1, true, "Relaxation"});
    bind_linear_light(p, o.linear_light);
    bind_region(p, o.region);
    bind_features(p, o.features, o.feature_angle);
}

constexpr std::uint32_t everything =
    vertex_color | vertex_quality | vertex_texcoord | wedge_texcoord | custom_attributes;

}  // namespace

const Plugin& table() {
    static const Plugin plugin{
        "FilterMultiresAttributes",
        {
            filter<AttributeRelaxationOptions>(
                {"Multiresolution: Relax Attributes",
                 "apply_attributes_multires_relaxation",
                 std::string("Smooths attributes along the surface: colours with alpha, quality, texture coordinates, "
                             "custom scalars and points. Every value becomes a mean of those around it with weights "
                             "from the geometry, which itself stays as it is. Colours are rounded once, at the end."
                             "<br>") +
                     cite_roy,
                 MenuClass::smoothing,
                 faces,
                 everything,
                 everything,
                 {},
                 {}},
                relaxation_defaults, bind_relaxation, relax_attributes),
        }};
    return plugin;
}

}  // namespace multires::plugin
