#include "shared/attribute_bindings.h"
#include "shared/returns.h"

#include "filters/attributes/attributes.h"
#include "filters/attributes/attributes_band.h"
#include "filters/attributes/texcoord.h"

// Filters that work on attributes of the surface and leave its shape alone.

namespace multires::plugin {
namespace {

AttributeRelaxationOptions relaxation_defaults(const Layer* layer) {
    AttributeRelaxationOptions o;
    o.what = default_choice(layer);
    o.region.selected = has_selection(layer);
    return o;
}

void bind_relaxation(Parameters& p, AttributeRelaxationOptions& o) {
    bind_color_and_quality(p, o.what);
    p.boolean("texcoord", o.what.texcoord,
              {"Vertex texture coordinates", "Of the vertices.", 0, 1, false, attribute_group});
    p.boolean("wedge_texcoord", o.what.wedge_texcoord,
              {"Wedge texture coordinates",
               "Of the faces' corners, chart by chart: corners with the same vertex and the same texture coordinate "
               "stay together.",
               0, 1, false, attribute_group});
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

AttributeBandOptions band_defaults(const Layer* layer) {
    AttributeBandOptions o;
    o.what.quality = layer && default_choice(layer).quality;
    o.what.color = !o.what.quality;
    o.band.coarsest = o.cutoff = 1;
    if (layer) {
        o.band = default_band(*layer, Unit::wavelength);
        o.cutoff = default_cutoff(*layer, Unit::wavelength);
    }
    o.region.selected = has_selection(layer);
    return o;
}

AttributeBandOptions custom_band_defaults(const Layer* layer) {
    AttributeBandOptions o = band_defaults(layer);
    o.what = {};
    o.what.custom = true;
    return o;
}

void bind_how(Parameters& p, AttributeBandOptions& o) {
    p.choice("mode", o.mode, {"low pass", "stop band", "enhance"},
             {"Mode",
              "Low pass: remove everything finer than the cutoff. Stop band: remove what is between finest and "
              "coarsest. Enhance: multiply it by the gain.",
              0, 2, false, "Band"});
    p.slider("gain", o.gain,
             {"Gain", "For enhance: 1 changes nothing, 2 doubles the details of the band, 0 removes them.", 0, 8, false,
              "Band"});
    p.real("cutoff", o.cutoff,
           {"Cutoff",
            "For low pass: everything finer than this is removed: shorter waves, lower levels, levels with more "
            "vertices.",
            0, 1e30, false, "Band"});
    bind_band(p, o.band);
    bind_region(p, o.region);
    bind_pyramid(p, o.pyramid);
}

void bind_attribute_band(Parameters& p, AttributeBandOptions& o) {
    bind_color_and_quality(p, o.what);
    bind_linear_light(p, o.linear_light);
    bind_how(p, o);
}

void bind_custom_band(Parameters& p, AttributeBandOptions& o) {
    p.text("custom_names", o.what.custom_names, custom_names_hint);
    bind_how(p, o);
}

Result run_band(const Layer& layer, const AttributeBandOptions& options, Session& session) {
    AttributeBandOptions o = options;
    if (is_still(o.cutoff, default_cutoff(layer, Unit::wavelength))) o.cutoff = default_cutoff(layer, o.band.unit);
    if (o.mode != BandMode::low_pass) o.band = in_own_unit(layer, o.band);
    return filter_attribute_bands(layer, o, session);
}

TexcoordOptions texcoord_defaults(const Layer* /*layer*/) { return {}; }

void bind_texcoord(Parameters& p, TexcoordOptions& o) {
    const char* texture = "Texture coordinates";
    p.choice("projection", o.projection, {"cylindrical", "spherical", "planar", "existing"},
             {"Projection",
              "Where the coarse level gets its coordinates from: a cylinder or sphere about the axis, the plane across "
              "it, or the texture coordinates its vertices have.",
              0, 3, false, texture});
    p.choice("axis", o.axis, {"principal", "x", "y", "z"},
             {"Axis",
              "Axis of the projection, through the centroid. Principal: along the longest extent of the shape, for a "
              "planar projection along the shortest.",
              0, 3, false, texture});
    p.integer("coarse_vertices", o.coarse_vertices,
              {"Coarse vertices",
               "The first level with so many vertices or fewer is the one that is projected; all finer ones follow "
               "smoothly. More follow the shape more closely, fewer vary more smoothly.",
               1, 1000000000, false, texture});
    bind_pyramid(p, o.pyramid);
}

constexpr std::uint32_t everything =
    vertex_color | vertex_quality | vertex_texcoord | wedge_texcoord | custom_attributes;

const Returns relaxation_returns{
    {"kept_vertices", Type::integer, "", "Vertices whose values were kept: corners, or without neighbours.", false},
    {"seam_vertices", Type::integer, "", "Vertices on seams of the wedge texture coordinates.", false},
};

const Returns texcoord_returns{
    {"level", Type::integer, "", "The level that was projected."},
    {"coarse_vertices", Type::integer, "", "Its vertices."},
    {"axis", Type::list, "", "Direction of the projection's axis, a unit vector.", false},
    {"seam_faces", Type::integer, "", "Faces across the seam of a cylinder or sphere, whose wedges go on beyond 1."},
    {"pole_faces", Type::integer, "", "Faces around a pole of the projection."},
};

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
                 {},
                 relaxation_returns + attribute_returns},
                relaxation_defaults, bind_relaxation, relax_attributes),
            filter<AttributeBandOptions>(
                {"Multiresolution: Filter Attributes by Band",
                 "apply_attributes_multires_band",
                 std::string("Low pass, stop band or enhancement of vertex colour or quality by scale, through the "
                             "pyramid of the surface. The geometry stays as it is.<br>") +
                     cite_roy + cite_guskov,
                 MenuClass::smoothing,
                 faces,
                 vertex_color | vertex_quality,
                 vertex_color | vertex_quality,
                 {},
                 {},
                 gains_returns + attribute_returns + pyramid_returns},
                band_defaults, bind_attribute_band, run_band),
            filter<AttributeBandOptions>(
                {"Multiresolution: Filter Custom Attributes by Band",
                 "apply_attributes_multires_band_custom",
                 std::string("Low pass, stop band or enhancement of custom scalars and points of the vertices by "
                             "scale, through the pyramid of the surface. The geometry stays as it is.<br>") +
                     cite_roy + cite_guskov,
                 MenuClass::smoothing,
                 faces,
                 vertex_quality | custom_attributes,
                 custom_attributes,
                 {},
                 {},
                 gains_returns + attribute_returns + pyramid_returns},
                custom_band_defaults, bind_custom_band, run_band),
            filter<TexcoordOptions>(
                {"Multiresolution: Generate Texture Coordinates",
                 "generate_multires_texcoord",
                 std::string(
                     "Projects a coarse level of the pyramid to a cylinder, a sphere or a plane and subdivides "
                     "its texture coordinates to the finest level: they vary smoothly however rough the surface "
                     "is. Makes vertex and wedge texture coordinates; wedges go on beyond 1 where a face "
                     "crosses the seam.<br>") +
                     cite_guskov,
                 MenuClass::texture,
                 faces,
                 vertex_texcoord | wedge_texcoord,
                 vertex_texcoord | wedge_texcoord,
                 {},
                 {},
                 texcoord_returns + pyramid_returns},
                texcoord_defaults, bind_texcoord, generate_texcoord),
        }};
    return plugin;
}

}  // namespace multires::plugin
