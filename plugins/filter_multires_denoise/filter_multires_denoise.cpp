#include "shared/attribute_bindings.h"
#include "shared/returns.h"

#include "filters/attributes/attributes_denoise.h"
#include "filters/shape/denoise.h"

// Filters that remove noise and keep shape.

namespace multires::plugin {
namespace {

DenoiseOptions denoise_defaults(const Layer* layer) {
    DenoiseOptions o;
    o.region.selected = has_selection(layer);
    return o;
}

void bind_threshold(Parameters& p, DenoiseOptions& o) {
    const char* group = "Threshold";
    p.add("threshold_unit", Choice(o.unit, {"automatic", "mesh units", "percent", "share"}), "Threshold",
          "Automatic: from the noise found in the mesh. Mesh units, or percent of the diagonal of the bounding box: "
          "the value below. Share, for the threshold methods: the value below is the percentage of the details that "
          "goes, the shortest of all levels chosen.")
        .in(group);
    p.add("threshold", &o.threshold, "Threshold value",
          "Size of the noise if the threshold is not automatic: its standard deviation for automatic and normal "
          "field, the length up to which details are dropped for the others.")
        .at_least(0)
        .in(group);
    p.add("strength", &o.strength, "Strength",
          "Factor for the noise: 1 removes the noise found, 2 takes twice as much for noise, 0 changes nothing. "
          "The threshold methods use it if their threshold is automatic.")
        .slider(0, 4)
        .in(group);
}

void bind_denoise(Parameters& p, DenoiseOptions& o) {
    p.add("method", Choice(o.method, {"normal field", "soft threshold", "hard threshold", "automatic"}), "Method",
          "Automatic: measures the noise and blends low passes, local Wiener filters, the normal field and the mesh as "
          "it is so that the result is expected to be nearest to the truth. Normal field: denoises the face normals "
          "over several scales and moves the vertices to fit; tunes itself "
          "and keeps sharp edges. Soft threshold: shrinks the pyramid's details (Roy). Hard threshold: drops small "
          "details and leaves large ones.")
        .in("Method");
    bind_threshold(p, o);
    p.add("fast", &o.fast, "Fast",
          "Automatic: the noise of meshes of more than 25,000 vertices is measured on parts of them. About half the "
          "time; what is left of the noise is a few percent more.")
        .in("Method");
    p.add("keep_volume", &o.keep_volume, "Keep volume",
          "Shift the surface along its normals until the volume is that of the input.")
        .in("Method");
    p.add("confidence", &o.confidence, "Quality as confidence",
          "Vertex quality says how far a vertex is trusted: 1 stays, 0 gets the full threshold.")
        .in("Region");
    bind_region(p, o.region);
    bind_relative_to(p, o.relative_to);
    const char* details = "Thresholding";
    p.add("finest_level", &o.finest_level, "Finest level",
          "Thresholding: first level whose details are shrunk, 0 is the finest.")
        .at_least(0)
        .advanced(details);
    p.add("coarsest_level", &o.coarsest_level, "Coarsest level",
          "Thresholding: details of levels up to, but not with, this one are shrunk.")
        .at_least(1)
        .advanced(details);
    p.add("per_level", &o.per_level, "Threshold per level",
          "Thresholding: scale the automatic threshold to the noise each level holds.")
        .advanced(details);
    p.add("normal_only", &o.normal_only, "Along the normal only",
          "Thresholding: leave the tangential part of details as it is.")
        .advanced(details);
    p.add("cycle_spins", &o.cycle_spins, "Cycle spinning",
          "Thresholding: average over so many different hierarchies; the time grows with it.")
        .between(1, 64)
        .advanced(details);
    bind_pyramid(p, o.pyramid);
}

AttributeDenoiseOptions attribute_defaults(const Layer* layer) {
    AttributeDenoiseOptions o;
    o.what.quality = layer && default_choice(layer).quality;
    o.what.color = !o.what.quality;
    o.region.selected = has_selection(layer);
    return o;
}

void bind_attributes(Parameters& p, AttributeDenoiseOptions& o) {
    bind_color_and_quality(p, o.what);
    bind_custom(p, o.what);
    bind_custom_names(p, o.what);
    bind_linear_light(p, o.linear_light);
    const char* group = "Threshold";
    p.add(
         "rule", Choice(o.rule, {"soft", "hard", "automatic"}), "Rule",
         "Automatic: impulses are replaced, the noise is measured, at each vertex where it varies, and what comes "
         "nearest to the truth by its estimated risk is done: low passes, local Wiener filters, total variation, or "
         "nothing. Soft: details of the pyramid up to the threshold go, all others become shorter by it. Hard: details "
         "up to the threshold go, the others stay.")
        .in(group);
    p.add("automatic", &o.automatic, "Automatic threshold",
          "The noise is measured. Off: the threshold below is used, by the soft rule if the rule is automatic.")
        .in(group);
    p.add("strength", &o.strength, "Strength",
          "Factor for the noise that is measured, or the automatic threshold: 1 removes the noise found, 0 changes "
          "nothing.")
        .between(0, 100)
        .in(group);
    p.add("threshold", &o.threshold, "Threshold value",
          "If it is not automatic: the length up to which details are dropped, in units of the attribute, for colours "
          "of 255.")
        .at_least(0)
        .in(group);
    p.add("finest_level", &o.finest_level, "Finest level",
          "Thresholds only: first level that is denoised, 0 is the finest.")
        .at_least(0)
        .advanced(group);
    p.add("coarsest_level", &o.coarsest_level, "Coarsest level",
          "Thresholds only: levels up to, but not with, this one are denoised.")
        .at_least(1)
        .advanced(group);
    bind_region(p, o.region);
    bind_pyramid(p, o.pyramid);
}

const Returns denoise_returns{
    {"noise", Type::real, "mesh units", "Standard deviation of the noise found, along the normals."},
    {"noise_in_edges", Type::real, "", "Automatic: the same in mean edge lengths.", false},
    {"noise_least", Type::real, "mesh units", "Automatic: the same where it is least, if it varies.", false},
    {"noise_most", Type::real, "mesh units", "Automatic: the same where it is largest.", false},
    {"noise_in_all_directions", Type::boolean, "", "Automatic: the noise was found within the surface too.", false},
    {"noise_along_axis", Type::boolean, "", "Automatic: most of the noise goes along one axis of space.", false},
    {"rounding_step", Type::real, "mesh units",
     "Automatic: step that the coordinates were rounded to, if that is what the noise is; otherwise 0.", false},
    {"spikes_removed", Type::integer, "", "Vertices found to be impulses and set back first.", false},
    {"estimated_rms_before", Type::real, "mesh units",
     "Automatic: expected RMS distance of the vertices from the truth.", false},
    {"estimated_rms_after", Type::real, "mesh units", "Automatic: the same of the result.", false},
    {"share_low_pass", Type::real, "", "Automatic: weight of the low passes in the result.", false},
    {"share_wiener", Type::real, "", "Automatic: weight of the local Wiener filters.", false},
    {"share_normal_field", Type::real, "", "Automatic: weight of the normal field.", false},
    {"share_guided_normals", Type::real, "", "Automatic: weight of guided normals after it.", false},
    {"noise_per_level", Type::list, "",
     "Noise in the details of each level, finest first: of the normals, or with thresholding in mesh units.", false},
    {"normal_noise", Type::real, "", "Normal field: median difference of neighbouring unit normals.", false},
    {"normal_noise_after", Type::real, "", "Normal field: the same after denoising.", false},
    {"detail_per_level", Type::list, "", "Normal field: RMS detail of the normals on each level.", false},
    {"share_removed", Type::list, "", "Normal field: share of each level's details that was taken out.", false},
};

const Returns thresholding_returns{
    {"threshold_per_level", Type::list, "mesh units", "Thresholding: what was used on each level.", false},
    {"share_zeroed", Type::list, "", "Thresholding: share of the details that became 0, of each level.", false},
    {"pyramid_reused", Type::boolean, "", "Thresholding: the pyramid kept with the mesh was used.", false},
    {"locked_vertices", Type::integer, "", "Thresholding: vertices at non-manifold edges or points.", false},
    {"unreferenced_vertices", Type::integer, "", "Thresholding: vertices without a face.", false},
};

const Returns attribute_noise_returns{
    {"*_noise", Type::real, "units of the attribute", "Deviation of the noise found.", false},
    {"*_noise_least", Type::real, "units of the attribute", "Automatic: the same where it is least.", false},
    {"*_noise_most", Type::real, "units of the attribute", "Automatic: the same where it is largest.", false},
    {"*_impulses", Type::integer, "", "Automatic: vertices whose values were found to be impulses and replaced.",
     false},
    {"*_rounding_step", Type::real, "units of the attribute",
     "Automatic: step that the values were rounded to, if that is what the noise is; otherwise 0.", false},
    {"*_estimated_rms_before", Type::real, "units of the attribute", "Automatic: expected RMS error of the values.",
     false},
    {"*_estimated_rms_after", Type::real, "units of the attribute", "Automatic: the same of the result.", false},
    {"*_share_low_pass", Type::real, "", "Automatic: weight of the low passes in the result.", false},
    {"*_share_wiener", Type::real, "", "Automatic: weight of the local Wiener filters.", false},
    {"*_share_total_variation", Type::real, "", "Automatic: weight of total variation.", false},
    {"*_noise_per_level", Type::list, "units of the attribute", "Thresholds: noise in the details of each level.",
     false},
    {"*_threshold", Type::list, "units of the attribute", "Thresholds: what was used on each level.", false},
    {"*_zeroed", Type::list, "", "Thresholds: share of each level's details that became 0.", false},
};

}  // namespace

const Plugin& table() {
    static const Plugin plugin{
        "FilterMultiresDenoise",
        {
            filter({"Multiresolution: Denoise", "apply_coord_multires_denoise",
                    std::string("Removes noise and keeps shape, without a parameter to set: the noise is measured, and "
                                "what is done is chosen by the estimated distance from the truth.<br>") +
                        cite_roy +
                        "<br>See <i>Sun, Rosin, Martin, Langbein</i>, <b>\"Fast and Effective Feature-Preserving Mesh "
                        "Denoising\"</b>, IEEE TVCG 2007.<br>See <i>Zheng, Fu, Au, Tai</i>, <b>\"Bilateral Normal "
                        "Filtering for Mesh Denoising\"</b>, IEEE TVCG 2011.<br>See <i>Ramani, Blu, Unser</i>, "
                        "<b>\"Monte-Carlo SURE\"</b>, IEEE Transactions on Image Processing 2008.",
                    MenuClass::smoothing, faces | closed_seams, vertex_quality, vertex_positions,
                    denoise_returns + change_returns + thresholding_returns},
                   denoise_defaults, bind_denoise, denoise),
            filter(
                {"Multiresolution: Denoise Attributes", "apply_attributes_multires_denoise",
                 std::string("Removes noise from vertex colour, quality or custom attributes, without a parameter to "
                             "set: the noise and impulses are measured, and what is done is chosen by the estimated "
                             "error; the geometry stays as it is. The report says what was found and done.<br>See "
                             "<i>Rudin, Osher, Fatemi</i>, <b>\"Nonlinear total variation based noise removal "
                             "algorithms\"</b>, Physica D 1992.<br>See <i>Ramani, Blu, Unser</i>, "
                             "<b>\"Monte-Carlo SURE\"</b>, IEEE Transactions on Image Processing 2008.<br>") +
                     cite_roy,
                 MenuClass::smoothing, faces | closed_seams, vertex_color | vertex_quality | custom_attributes,
                 vertex_color | vertex_quality | custom_attributes,
                 attribute_returns + attribute_noise_returns + sometimes(pyramid_returns)},
                attribute_defaults, bind_attributes, denoise_attributes),
        }};
    return plugin;
}

}  // namespace multires::plugin
