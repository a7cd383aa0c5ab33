#pragma once

#include "shared/table.h"

#include "filters/original.h"
#include "filters/region.h"
#include "pyramid/band.h"

/// Bindings of the option structs that several filters share, and the citations of their info texts.
namespace multires::plugin {

// Short: MeshLab 2020.09 shows the info above the parameters, and its dialogs neither scroll nor fold.
inline const char* const cite_guskov = "<br>See <i>Guskov, Sweldens, Schr&ouml;der</i>, "
                                       "<b>\"Multiresolution Signal Processing for Meshes\"</b>, SIGGRAPH 1999.";

inline const char* const cite_roy =
    "<br>See <i>Roy, Foufou, Koschan, Truchetet, Abidi</i>, "
    "<b>\"Multiresolution Analysis for Irregular Meshes\"</b>, SPIE Photonics Technologies 2003.";

inline const std::vector<std::string> operator_names = {
    "umbrella",           "cotangent",         "cotangent clamped",
    "cotangent Delaunay", "second difference", "second difference with flaps",
};

inline void bind_features(Parameters& p, Features& features, double& angle) {
    const char* group = "Features";
    p.choice("features", features, {"none", "by angle", "edges not faux", "selected edges"},
             {"Sharp edges",
              "Edges that are not smoothed across: none; those where the normals of the two faces differ by more than "
              "the feature angle; those not marked as faux; those selected on their faces.",
              0, 3, true, group});
    p.real("feature_angle", angle,
           {"Feature angle", "Degrees between the normals of two faces above which their edge is sharp.", 0.01, 179.99,
            true, group});
}

inline void bind_operator(Parameters& p, Operator& op, const char* group) {
    p.choice("operator", op, operator_names,
             {"Operator",
              "Relaxation operator: how a vertex is predicted from its neighbours. Second differences keep shape best; "
              "cotangent weights are "
              "faster and shrink; the umbrella ignores geometry and lets vertices drift.",
              0, 5, true, group});
}

inline void bind_pyramid(Parameters& p, PyramidOptions& o) {
    const char* group = "Pyramid";
    p.choice("scheme", o.scheme.row, scheme_names(),
             {"Scheme", scheme_tooltip(), 0, static_cast<double>(schemes().size() - 1), true, group});
    bind_operator(p, o.scheme.op, group);
    p.real("presmooth", o.scheme.presmooth,
           {"Presmoothing",
            "Share of a relaxation step taken before vertices are removed, 0 to 1. It keeps fine noise out of coarse "
            "levels; 0 is what the papers do.",
            0, 1, true, group});
    p.choice("grouping", o.hierarchy.grouping, {"independent sets", "sequential"},
             {"Levels",
              "Independent sets: each level removes about a quarter of the vertices, none of them neighbours (Roy). "
              "Sequential: one vertex after the other, cheapest first (Guskov).",
              0, 1, true, group});
    p.choice("storage", o.scheme.storage, {"double", "float"},
             {"Storage",
              "How the pyramid keeps weights and details. Float takes half the memory, for meshes of many millions of "
              "vertices; unchanged bands then come back to about 1e-8 of the mesh's size instead of 1e-15.",
              0, 1, true, group});
    p.integer(
        "sets_per_level", o.hierarchy.sets_per_level,
        {"Sets per level",
         "Independent sets only: how many sets, a quarter of the vertices each, a level removes. 2 separates bands "
         "best; 1 sees most of the noise.",
         1, 100, true, group});
    p.real("level_ratio", o.hierarchy.level_ratio,
           {"Level ratio",
            "Sequential only: share of its vertices that a level keeps, for example 0.8; 0 makes every vertex a level "
            "of its own.",
            0, 0.99, true, group});
    p.integer("base_vertices", o.hierarchy.base_vertices,
              {"Base vertices", "Vertices at which the pyramid stops.", 4, 1000000000, true, group});
    p.real("length_weight", o.hierarchy.length_weight,
           {"Even spacing",
            "Weight of edge length against the quadric error when vertices are chosen: 0 keeps vertices where the "
            "surface bends, 1 keeps them evenly spaced.",
            0, 1000, true, group});
    p.real("normal_limit", o.hierarchy.normal_limit_degrees,
           {"Normal limit", "Degrees by which removing a vertex may turn a face at most.", 1, 180, true, group});
    bind_features(p, o.features.from, o.features.angle);
}

inline void bind_region(Parameters& p, Region& region) {
    p.boolean("selected", region.selected,
              {"Only on selection",
               "Change selected vertices and the vertices of selected faces only. The selection stays as it is.", 0, 1,
               false, "Region"});
    p.boolean("quality_mask", region.quality_mask,
              {"Quality as mask",
               "Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are "
               "clamped.",
               0, 1, false, "Region"});
}

inline void bind_relative_to(Parameters& p, RelativeTo& relative_to) {
    p.choice("relative_to", relative_to, {"current shape", "original"},
             {"Relative to",
              "Current shape: the filter changes the mesh as it is now. Original: it starts again from the shape the "
              "mesh had before any Multiresolution filter moved it, so that changes do not add up, and values that "
              "change nothing (gains of 1) bring exactly that shape back. Outside the selection the mesh stays as it "
              "is. The original is kept with the layer until something else changes the mesh; files do not hold it.",
              0, 1, false, "Region"});
}

inline void bind_unit(Parameters& p, Unit& unit) {
    p.choice("unit", unit, {"wavelength", "wavelength percent", "level", "vertices"},
             {"Unit",
              "What the limits are given in. Wavelength: length of a wave on the surface in mesh units; the finest a "
              "mesh can carry is twice its mean edge length. Wavelength percent: the same, 1 is 1 % of the diagonal of "
              "the bounding box. Level: of the pyramid, 0 is the finest. Vertices: how many vertices the level has. If "
              "you change only the unit, the default limits are converted.",
              0, 3, false, "Band"});
}

inline void bind_softness(Parameters& p, double& softness) {
    p.real(
        "softness", softness,
        {"Softness", "Width of the band's edges in octaves of wavelength; 0 is a sharp edge.", 0, 10, false, "Band"});
}

/// True where a filter that honours the selection should do so by default.
inline bool has_selection(const Layer* layer) {
    return layer && !(layer->selected_vertex.empty() && layer->selected_face.empty());
}

/// True if a value read from the host is still the default that was shown; hosts may pass it as a float.
inline bool is_still(double value, double shown) { return static_cast<float>(value) == static_cast<float>(shown); }

/// The band in its unit, where limits still at the default shown (in wavelengths) are converted.
inline Band in_own_unit(const Layer& layer, Band band) {
    if (band.unit == Unit::wavelength) return band;
    const Band shown = default_band(layer, Unit::wavelength), own = default_band(layer, band.unit);
    if (is_still(band.finest, shown.finest)) band.finest = own.finest;
    if (is_still(band.coarsest, shown.coarsest)) band.coarsest = own.coarsest;
    return band;
}

inline void bind_band(Parameters& p, Band& band) {
    bind_unit(p, band.unit);
    p.real("finest", band.finest,
           {"Finest", "Fine limit of the band, in the unit chosen: short waves, low levels, many vertices.", 0, 1e30,
            false, "Band"});
    p.real("coarsest", band.coarsest,
           {"Coarsest", "Coarse limit of the band, in the unit chosen: long waves, high levels, few vertices.", 0, 1e30,
            false, "Band"});
    bind_softness(p, band.softness);
}

}  // namespace multires::plugin
