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
    p.add("texcoord", &o.what.texcoord, "Vertex texture coordinates", "Of the vertices.").in(attribute_group).derived();
    p.add("wedge_texcoord", &o.what.wedge_texcoord, "Wedge texture coordinates",
          "Of the faces' corners, chart by chart: corners with the same vertex and the same texture coordinate "
          "stay together.")
        .in(attribute_group)
        .derived();
    bind_custom(p, o.what).derived();
    bind_custom_names(p, o.what);
    p.add("iterations", &o.iterations, "Iterations", "Steps of relaxation; each reaches a ring further.")
        .between(1, 10000)
        .in("Relaxation");
    p.add("strength", &o.strength, "Strength",
          "Share of each step that is taken: 1 replaces a value by the mean around it.")
        .between(1e-6, 1)
        .in("Relaxation");
    p.add("operator", Choice(o.op, pyramid_option("operator").choices), "Relaxation operator",
          "Weights of the neighbours, from the geometry. Delaunay cotangents: means in the strict sense, that keep "
          "linear functions on planes. Cotangents: those of the paper, which may be negative on bad triangles. The "
          "umbrella ignores geometry.")
        .advanced("Relaxation");
    p.add("corner_angle", Angle{&o.corner_angle}, "Corner angle",
          "Degrees: where the boundary turns by more than this, values are kept.")
        .between(0, 180)
        .advanced("Relaxation");
    p.add("keep_outline", &o.keep_outline, "Keep outlines of texture charts",
          "Keep texture coordinates on seams and boundaries as they are, so that charts keep their outline in the "
          "picture. Off: they are relaxed along the outline, both sides of a seam alike.")
        .advanced("Relaxation");
    bind_linear_light(p, o.linear_light);
    bind_region(p, o.region);
    bind_features(p, o.features, o.feature_angle);
}

struct AttributeBandRow : AttributeBandOptions {
    bool cutoff_given = false;
    GivenLimits given;
};

AttributeBandRow band_defaults(const Layer* layer) {
    AttributeBandRow o;
    o.what.quality = layer && default_choice(layer).quality;
    o.what.color = !o.what.quality;
    o.band.coarsest = o.cutoff = 1;
    if (layer) {
        o.band = default_band(*layer, Unit::wavelength);
        o.cutoff = default_cutoff(*layer, Unit::wavelength);
        o.calibration.method = default_method(layer->mesh);
    }
    o.region.selected = has_selection(layer);
    return o;
}

AttributeBandRow custom_band_defaults(const Layer* layer) {
    AttributeBandRow o = band_defaults(layer);
    o.what = {};
    o.what.custom = true;
    return o;
}

void bind_how(Parameters& p, AttributeBandRow& o) {
    p.add("mode", Choice(o.mode, {"low pass", "stop band", "enhance"}), "Mode",
          "Low pass: remove everything finer than the cutoff. Stop band: remove what is between finest and "
          "coarsest. Enhance: multiply it by the gain.")
        .in("Band");
    p.add("gain", &o.gain, "Gain", "For enhance: 1 changes nothing, 2 doubles the details of the band, 0 removes them.")
        .slider(0, 10)
        .in("Band");
    p.add("cutoff", &o.cutoff, "Cutoff",
          "For low pass: everything finer than this is removed: shorter waves, lower levels, levels with more "
          "vertices.")
        .at_least(0)
        .in("Band")
        .derived(o.cutoff_given);
    bind_band(p, o.band, o.given);
    bind_calibration(p, o.calibration);
    bind_region(p, o.region);
    bind_pyramid(p, o.pyramid);
}

void bind_attribute_band(Parameters& p, AttributeBandRow& o) {
    bind_color_and_quality(p, o.what);
    bind_linear_light(p, o.linear_light);
    bind_how(p, o);
}

void bind_custom_band(Parameters& p, AttributeBandRow& o) {
    bind_custom_names(p, o.what);
    bind_how(p, o);
}

Result run_band(const Layer& layer, const AttributeBandRow& row, Session& session) {
    AttributeBandOptions o = row;
    if (!row.cutoff_given) o.cutoff = default_cutoff(layer, o.band.unit);
    o.band = with_derived_limits(layer, o.band, row.given);
    return filter_attribute_bands(layer, o, session);
}

TexcoordOptions texcoord_defaults(const Layer* /*layer*/) { return {}; }

void bind_texcoord(Parameters& p, TexcoordOptions& o) {
    const char* texture = "Texture coordinates";
    p.add("projection", Choice(o.projection, {"cylindrical", "spherical", "planar", "existing"}), "Projection",
          "Where the coarse level gets its coordinates from: a cylinder or sphere about the axis, the plane across "
          "it, or the texture coordinates its vertices have.")
        .in(texture);
    p.add("axis", Choice(o.axis, {"principal", "x", "y", "z"}), "Axis",
          "Axis of the projection, through the centroid. Principal: along the longest extent of the shape, for a "
          "planar projection along the shortest.")
        .in(texture);
    p.add("coarse_vertices", &o.coarse_vertices, "Coarse vertices",
          "The first level with so many vertices or fewer is the one that is projected; all finer ones follow "
          "smoothly. More follow the shape more closely, fewer vary more smoothly.")
        .at_least(1)
        .in(texture);
    bind_pyramid(p, o.pyramid);
}

constexpr std::uint32_t everything = vertex_attributes | wedge_texcoord;

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
            filter(
                {"Multiresolution: Relax Attributes", "apply_attributes_multires_relaxation",
                 std::string("Smooths attributes along the surface: colours with alpha, quality, texture coordinates, "
                             "custom scalars and points. Every value becomes a mean of those around it with weights "
                             "from the geometry, which itself stays as it is. Colours are rounded once, at the end."
                             "<br>") +
                     cite_roy,
                 MenuClass::smoothing, faces | closed_seams, everything, everything,
                 relaxation_returns + attribute_returns},
                relaxation_defaults, bind_relaxation, relax_attributes),
            filter({"Multiresolution: Filter Attributes by Band", "apply_attributes_multires_band",
                    std::string("Low pass, stop band or enhancement of vertex colour or quality by scale, through the "
                                "pyramid of the surface. The geometry stays as it is.<br>") +
                        cite_roy + cite_guskov,
                    MenuClass::smoothing, faces | closed_seams, vertex_color | vertex_quality,
                    vertex_color | vertex_quality, band_returns + attribute_returns},
                   band_defaults, bind_attribute_band, run_band),
            filter({"Multiresolution: Filter Custom Attributes by Band", "apply_attributes_multires_band_custom",
                    std::string("Low pass, stop band or enhancement of custom scalars and points of the vertices by "
                                "scale, through the pyramid of the surface. The geometry stays as it is.<br>") +
                        cite_roy + cite_guskov,
                    MenuClass::smoothing, faces | closed_seams, vertex_quality | custom_attributes, custom_attributes,
                    band_returns + attribute_returns},
                   custom_band_defaults, bind_custom_band, run_band),
            filter({"Multiresolution: Generate Texture Coordinates", "generate_multires_texcoord",
                    std::string(
                        "Projects a coarse level of the pyramid to a cylinder, a sphere or a plane and subdivides "
                        "its texture coordinates to the finest level: they vary smoothly however rough the surface "
                        "is. Makes vertex and wedge texture coordinates; wedges go on beyond 1 where a face "
                        "crosses the seam.<br>") +
                        cite_guskov,
                    MenuClass::texture, faces | closed_seams, vertex_texcoord | wedge_texcoord,
                    vertex_texcoord | wedge_texcoord, texcoord_returns + pyramid_returns},
                   texcoord_defaults, bind_texcoord, generate_texcoord),
        }};
    return plugin;
}

}  // namespace multires::plugin
