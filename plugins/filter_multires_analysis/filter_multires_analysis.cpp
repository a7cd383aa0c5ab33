#include "shared/bindings.h"
#include "shared/returns.h"

#include "filters/analysis/roughness.h"

// Filters that measure: roughness, relief, details by scale, features.

namespace multires::plugin {
namespace {

struct RoughnessRow : RoughnessOptions {
    bool l_filter_given = false;
};

RoughnessRow roughness_defaults(const Layer* layer) {
    RoughnessRow o;
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

void bind_roughness(Parameters& p, RoughnessRow& o) {
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
        .derived(o.l_filter_given);
    bind_order(p, o.order, "Heights");
    p.add("selected", &o.selected, "Only on selection",
          "Measure the faces whose vertices are all selected, or in selected faces.")
        .in("Region")
        .derived();
}

Result run_roughness(const Layer& layer, const RoughnessRow& row, Session& session) {
    return roughness(layer, row, session);
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
                    MenuClass::measure, faces, none, none, roughness_returns},
                   roughness_defaults, bind_roughness, run_roughness),
        }};
    return plugin;
}

}  // namespace multires::plugin
