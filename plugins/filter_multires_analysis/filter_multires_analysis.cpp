#include "shared/bindings.h"
#include "shared/returns.h"

#include "filters/analysis/feature_lines.h"
#include "filters/analysis/relief.h"
#include "filters/analysis/roughness.h"
#include "filters/analysis/scales.h"
#include "measure/measure.h"

#include <algorithm>

// Filters that measure: roughness, relief, details by scale, features.

namespace multires::plugin {
namespace {

RoughnessOptions roughness_defaults(const Layer* layer) {
    RoughnessOptions o;
    o.l_filter = layer ? default_cutoff(*layer, Unit::wavelength) : 1;
    o.selected = has_selection(layer);
    return o;
}

void bind_order(Parameters& p, LowPassOrder& order, const char* group) {
    p.add("order", Choice(order, {"1", "2", "4", "gaussian"}), "Order",
          "How steeply a limit separates. With s = (limit / wave)^2, waves keep 1 / (1 + s), 1 / (1 + s^2) "
          "(ISO 16610-22), 1 / (1 + s^4) or exp(-ln 2 s) (ISO 16610-21).")
        .advanced(group);
}

void bind_roughness(Parameters& p, RoughnessOptions& o) {
    p.add("form", Choice(o.form, {"none", "plane", "sphere", "cylinder", "low pass"}), "Form",
          "What heights count from (F-operation). Plane, sphere, cylinder: fitted. Low pass: the shape without waves "
          "shorter than the L-filter, for any shape. None: the xy plane, for height maps that are level.")
        .in("Heights");
    p.add("s_filter", &o.s_filter, "S-filter",
          "Nesting index, mesh units: shorter waves do not count. At least two mean edges; 0: all count.")
        .at_least(0)
        .in("Heights");
    p.add("l_filter", &o.l_filter, "L-filter",
          "Nesting index, mesh units: longer waves do not count. More than the S-filter; 0: all count (not with low "
          "pass).")
        .at_least(0)
        .in("Heights")
        .derived();
    bind_order(p, o.order, "Heights");
    p.add("selected", &o.selected, "Only on selection",
          "Measure the faces whose vertices are all selected, or in selected faces.")
        .in("Region")
        .derived();
}

const char* const cite_iso_25178 =
    "<br>See <i>ISO/TC 213</i>, <b>\"ISO 25178-2: Surface texture: Areal, Part 2: Terms, definitions and surface "
    "texture parameters\"</b>, 2021.";

const Returns roughness_returns{
    {"solver_reused", Type::boolean, "",
     "The solver kept with the mesh was used; otherwise one was set up and kept (low pass).", false},
    {"form_radius", Type::real, "mesh units", "Radius of the fitted sphere or cylinder.", false},
    {"area", Type::real, "square mesh units", "Area of the surface that heights count from."},
    {"sa", Type::real, "mesh units", "Arithmetical mean height."},
    {"sq", Type::real, "mesh units", "Root mean square height."},
    {"sp", Type::real, "mesh units", "Maximum peak height."},
    {"sv", Type::real, "mesh units", "Maximum pit height."},
    {"sz", Type::real, "mesh units", "Maximum height, Sp + Sv."},
    {"ssk", Type::real, "", "Skewness: below 0 with pits, above with peaks."},
    {"sku", Type::real, "", "Kurtosis: 3 for a normal distribution."},
    {"sdq", Type::real, "", "Root mean square gradient."},
    {"sdr", Type::real, "percent", "Developed interfacial area ratio."},
    {"heights", Type::list, "mesh units", "Limits of the histogram, from the mean height; one more than shares."},
    {"shares", Type::list, "", "Share of the area between two heights; sum 1."},
};

/// A dialog shows 0 where the band is to be chosen.
struct ReliefRow : ReliefOptions {
    double coarsest_shown = 0;
};

ReliefRow relief_defaults(const Layer* /*layer*/) { return {}; }

void bind_relief(Parameters& p, ReliefRow& o) {
    p.add(
         "coarsest", &o.coarsest_shown, "Coarsest",
         "Mesh units: the relief is what is left without waves longer than that, about three times as wide as strokes. "
         "At least two mean edges; 0: the band is chosen from the mesh.")
        .at_least(0)
        .in("Band");
    p.add("finest", &o.finest, "Finest",
          "Mesh units: shorter waves are left out as noise. At least two mean edges; 0: all count, or chosen with the "
          "coarsest.")
        .at_least(0)
        .in("Band");
    p.add("robust", &o.robust, "Robust",
          "The low pass does not give way to what is cut or raised (after ISO 16610-71): depths come out larger, and "
          "without a wall around strokes. Off: a linear low pass, calibrated.")
        .in("Band");
    bind_order(p, o.order, "Band");
    p.add("color", &o.color, "Colour", "Colour the vertices, too: blue is deep, grey level, red high.").in("Result");
}

Result run_relief(const Layer& layer, const ReliefRow& row, Session& session) {
    ReliefOptions o = row;
    if (row.coarsest_shown != 0) o.coarsest = row.coarsest_shown;
    return relief(layer, o, session);
}

const char* const cite_iso_16610 =
    "<br>See <i>ISO/TC 213</i>, <b>\"ISO 16610-62: Filtration: Linear areal filters: Spline filters\"</b>, 2023.";

const Returns relief_returns{
    {"solver_reused", Type::boolean, "", "The solver kept with the mesh was used; otherwise one was set up and kept."},
    {"finest", Type::real, "mesh units", "The fine limit of the band, 0 if there is none."},
    {"coarsest", Type::real, "mesh units", "The coarse limit."},
    {"lowest", Type::real, "mesh units", "The lowest height."},
    {"highest", Type::real, "mesh units", "The highest."},
    {"rms_height", Type::real, "mesh units", "Root mean square of the heights, by area."},
    {"skewness", Type::real, "", "Of the heights: below 0 where the relief is cut, above where it is raised."},
};

/// From three edges to an eighth of the diagonal, or as far as there is room.
ScaleOptions scales_defaults(const Layer* layer) {
    ScaleOptions o;
    o.finest = 1, o.coarsest = 2;
    if (!layer) return o;
    o.finest = std::max(1e-300, 3 * mean_edge_length(layer->mesh.faces, layer->mesh.positions));
    o.coarsest = std::max(2 * o.finest, box_diagonal(*layer) / 8);
    return o;
}

void bind_scales(Parameters& p, ScaleOptions& o) {
    p.add("bands", &o.bands, "Bands", "How many bands.").between(1, most_scales).in("Bands");
    p.add("finest", &o.finest, "Finest",
          "Mesh units: the first band holds the waves shorter than that. At least two mean edges. Not with one band.")
        .at_least(0)
        .in("Bands")
        .derived();
    p.add("coarsest", &o.coarsest, "Coarsest", "Mesh units: the last band ends at this wavelength.")
        .at_least(0)
        .in("Bands")
        .derived();
    p.add("values", Choice(o.values, {"bands", "heights"}), "Values",
          "Bands: what each band adds. Heights: what all bands up to it add, the height over the low pass, which goes "
          "with the volume integral invariant of a ball of 0.45 limits radius.")
        .in("Bands");
    p.add("prefix", &o.name, "Prefix", "The attributes are called so, followed by _1 (finest), _2, ...").in("Bands");
}

const char* const cite_mara =
    "<br>See <i>Mara, Kr&ouml;mker, Jakob, Breuckmann</i>, <b>\"GigaMesh and Gilgamesh: 3D Multiscale Integral "
    "Invariant Cuneiform Character Extraction\"</b>, VAST 2010.";

const Returns scales_returns{
    {"solver_reused", Type::boolean, "", "The solver kept with the mesh was used; otherwise one was set up and kept."},
    {"limits", Type::list, "mesh units", "Where each band ends; it begins where the one before ends."},
    {"wavelengths", Type::list, "mesh units", "The middle of each band: what the quality holds."},
    {"rms_details", Type::list, "mesh units", "Root mean square detail of each band, by area."},
};

FeatureLineOptions features_defaults(const Layer* /*layer*/) { return {}; }

void bind_feature_lines(Parameters& p, FeatureLineOptions& o) {
    p.add("strong", Angle{&o.strong}, "Strong angle", "Lines start at edges that bend by as much, at every scale.")
        .between(1, 179)
        .in("Lines");
    p.add("weak", Angle{&o.weak}, "Weak angle", "Lines go on along edges that bend by as much; at most the strong one.")
        .between(1, 179)
        .in("Lines");
    p.add("shortest", &o.shortest, "Shortest line",
          "Edges: shorter branches and loose lines are left out, and gaps of up to half of it are closed.")
        .between(0, 1000)
        .in("Lines");
    p.add("select", Choice(o.select, {"edges", "vertices"}), "Select",
          "Edges: what features=selected edges of the other filters then keeps sharp. Vertices: those on the lines.")
        .in("Result");
}

const char* const cite_hubeli = "<br>See <i>Hubeli, Gross</i>, <b>\"Multiresolution Feature Extraction for "
                                "Unstructured Meshes\"</b>, Visualization "
                                "2001.";

const Returns feature_returns{
    {"edges", Type::integer, "", "Edges on the lines."},
    {"vertices", Type::integer, "", "Vertices on the lines."},
    {"length", Type::real, "mesh units", "Length of all lines."},
    {"noise", Type::real, "", "Median difference of neighbouring normals before they were denoised."},
};

}  // namespace

const Plugin& table() {
    static const Plugin plugin{
        "FilterMultiresAnalysis",
        {
            filter({"Multiresolution: Roughness", "compute_multires_roughness",
                    std::string("Measures the texture of a surface by ISO 25178: Sa, Sq, Sp, Sv, Sz, Ssk, Sku, Sdq and "
                                "Sdr of the waves between two wavelengths, over a fitted form or, on any shape, over "
                                "its low pass. Changes nothing.<br>") +
                        cite_iso_25178,
                    MenuClass::measure, faces | closed_seams, none, none, roughness_returns},
                   roughness_defaults, bind_roughness, roughness),
            filter(
                {"Multiresolution: Relief", "compute_scalar_multires_relief_per_vertex",
                 std::string("Signed height over the low pass as vertex quality, in mesh units: carvings, tool marks, "
                             "wear. The band is chosen from the mesh unless one is given.<br>") +
                     cite_iso_16610,
                 MenuClass::quality, faces | closed_seams, none, vertex_quality | vertex_color, relief_returns},
                relief_defaults, bind_relief, run_relief),
            filter({"Multiresolution: Details by Scale", "compute_custom_multires_scales",
                    std::string("The signed detail of up to 16 bands of wavelengths as custom attributes of the "
                                "vertices, and as quality the wavelength at which a vertex stands out most: feature "
                                "vectors for classification, and for finding writing.<br>") +
                        cite_mara + cite_guskov,
                    MenuClass::quality, faces | closed_seams, none, vertex_quality | custom_attributes, scales_returns},
                   scales_defaults, bind_scales, scale_details),
            filter({"Multiresolution: Select Features", "compute_selection_multires_features",
                    std::string("Selects the lines along which a surface is sharp at every scale, with noise, too, and "
                                "cleans them: branches out, gaps closed.<br>") +
                        cite_hubeli,
                    MenuClass::quality, faces | closed_seams, none, vertex_selection | edge_selection, feature_returns},
                   features_defaults, bind_feature_lines, feature_lines),
        }};
    return plugin;
}

}  // namespace multires::plugin
