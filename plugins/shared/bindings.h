#pragma once

#include "shared/table.h"

#include "filters/calibration.h"
#include "filters/original.h"
#include "filters/region.h"
#include "pyramid/band.h"
#include "pyramid/options.h"

#include <cmath>
#include <type_traits>

/// Bindings of the option structs that several filters share, and the citations of their info texts.
namespace multires::plugin {

// Short: MeshLab 2020.09 shows the info above the parameters, and its dialogs neither scroll nor fold.
inline const char* const cite_guskov = "<br>See <i>Guskov, Sweldens, Schr&ouml;der</i>, "
                                       "<b>\"Multiresolution Signal Processing for Meshes\"</b>, SIGGRAPH 1999.";

inline const char* const cite_roy =
    "<br>See <i>Roy, Foufou, Koschan, Truchetet, Abidi</i>, "
    "<b>\"Multiresolution Analysis for Irregular Meshes\"</b>, SPIE Photonics Technologies 2003.";

/// The field of an option of pyramids as a parameter's.
template <class Value>
Field field_of(const PyramidOption& option, Value& value) {
    if constexpr (std::is_enum_v<Value>) {
        return Choice(value, option.choices);
    } else if constexpr (std::is_same_v<Value, int>) {
        return option.choices.empty() ? Field(&value) : Field(Choice(value, option.choices));
    } else if constexpr (std::is_same_v<Value, double>) {
        return option.degrees ? Field(Angle{&value}) : Field(&value);
    } else {
        return &value;
    }
}

/// An option of pyramids as a parameter: name, texts and range are those of pyramid/options.h.
template <class Value>
void bind_option(Parameters& p, const PyramidOption& option, Value& value, const std::string& group) {
    Parameter& parameter = p.add(option.name, field_of(option, value), option.label, option.tooltip);
    if (option.choices.empty() && std::isfinite(option.most)) parameter.between(option.least, option.most);
    if (option.choices.empty() && !std::isfinite(option.most)) parameter.at_least(option.least);
    parameter.advanced(group);
}

inline void bind_features(Parameters& p, Features& features, double& angle) {
    const char* const group = "Features";
    bind_option(p, pyramid_option("features"), features, group);
    bind_option(p, pyramid_option("feature_angle"), angle, group);
}

inline void bind_operator(Parameters& p, Operator& op, const char* group) {
    bind_option(p, pyramid_option("operator"), op, group);
}

inline void bind_pyramid(Parameters& p, PyramidOptions& o) {
    visit_options(o, [&](const PyramidOption& option, auto& field) {
        if (!option.label.empty()) bind_option(p, option, field, option.group);
    });
}

inline void bind_region(Parameters& p, Region& region) {
    p.add("selected", &region.selected, "Only on selection",
          "Change selected vertices and the vertices of selected faces only. The selection stays as it is.")
        .in("Region")
        .derived();
    p.add("quality_mask", &region.quality_mask, "Quality as mask",
          "Scale the effect at each vertex by its quality: 0 is no change, 1 the full one, values outside are "
          "clamped.")
        .in("Region");
}

inline void bind_relative_to(Parameters& p, RelativeTo& relative_to) {
    p.add("relative_to", Choice(relative_to, {"current shape", "original"}), "Relative to",
          "Current shape: the filter changes the mesh as it is now. Original: it starts again from the shape the "
          "mesh had before any Multiresolution filter moved it, so that changes do not add up, and values that "
          "change nothing (gains of 1) bring exactly that shape back. Outside the selection the mesh stays as it "
          "is. The original is kept with the layer until something else changes the mesh; files do not hold it.")
        .in("Region");
}

inline void bind_unit(Parameters& p, Unit& unit) {
    p.add("unit", Choice(unit, {"wavelength", "wavelength percent", "level", "vertices"}), "Unit",
          "What the limits are given in. Wavelength: length of a wave on the surface in mesh units; the finest a "
          "mesh can carry is twice its mean edge length. Wavelength percent: the same, 1 is 1 % of the diagonal of "
          "the bounding box. Level: of the pyramid, 0 is the finest. Vertices: how many vertices the level has. "
          "Scripts may leave limits out: they are then derived from the mesh, in this unit. In a dialog the numbers "
          "shown count.")
        .in("Band");
}

inline void bind_softness(Parameters& p, double& softness) {
    p.add("softness", &softness, "Softness",
          "Pyramid only: width of the band's edges in octaves of wavelength; 0 is a sharp edge.")
        .between(0, 10)
        .in("Band");
}

inline void bind_calibration(Parameters& p, Calibration& o) {
    const char* group = "Band";
    p.add(
         "method", Choice(o.method, {"pyramid", "spline"}), "Method",
         "Spline: calibrated, a limit is the wavelength of which exactly half belongs to either side; a sphere stays "
         "a sphere. Pyramid: limits are approximate; softness and the pyramid's options apply. By default the pyramid, "
         "which previews at once, but the spline where edges differ much in length, as CAD programs make them.")
        .in(group)
        .derived();
    p.add("order", Choice(o.order, {"1", "2", "4", "gaussian"}), "Order",
          "Spline only: how steeply a limit separates. With s = (limit / wave)^2, waves keep 1 / (1 + s), "
          "1 / (1 + s^2) (ISO 16610-22), 1 / (1 + s^4) or exp(-ln 2 s) (ISO 16610-21).")
        .advanced(group);
    p.add("measure", &o.measure, "Measure transmission",
          "Spline only: filter test waves on this very mesh and tell how much is left of waves of 0.7, 1 and 1.4 "
          "cutoffs. Takes a few times as long.")
        .advanced(group);
}

/// True where a filter that honours the selection should do so by default.
inline bool has_selection(const Layer* layer) {
    return layer && !(layer->selected_vertex.empty() && layer->selected_face.empty());
}

/// Which limits of a band the caller gave. The dialog's defaults are in the default unit; where another one is chosen,
/// limits that were not given are derived from the mesh again, in that unit. A given one is taken as it is, whatever
/// the default: dialogs give all that they show.
struct GivenLimits {
    bool finest = false, coarsest = false;
};

inline Band with_limits(Band band, const GivenLimits& given, const Band& derived) {
    if (!given.finest) band.finest = derived.finest;
    if (!given.coarsest) band.coarsest = derived.coarsest;
    return band;
}

inline Band with_derived_limits(const Layer& layer, const Band& band, const GivenLimits& given) {
    return with_limits(band, given, default_band(layer, band.unit));
}

inline void bind_gain(Parameters& p, double& gain) {
    p.add("gain", &gain, "Gain",
          "Factor for the details of the band: 1 changes nothing, 2 doubles them, 0 removes them.")
        .slider(0, 10)
        .in("Band");
}

inline void bind_band(Parameters& p, Band& band, GivenLimits& given) {
    bind_unit(p, band.unit);
    p.add("finest", &band.finest, "Finest",
          "Fine limit of the band, in the unit chosen: short waves, low levels, many vertices.")
        .at_least(0)
        .in("Band")
        .derived(given.finest);
    p.add("coarsest", &band.coarsest, "Coarsest",
          "Coarse limit of the band, in the unit chosen: long waves, high levels, few vertices.")
        .at_least(0)
        .in("Band")
        .derived(given.coarsest);
    bind_softness(p, band.softness);
}

}  // namespace multires::plugin
