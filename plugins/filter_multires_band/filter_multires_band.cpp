#include "shared/bindings.h"
#include "shared/returns.h"

#include "filters/shape/band_filters.h"

#include <cstdio>

// Filters that remove, weaken or strengthen bands of scales.

namespace multires::plugin {
namespace {

struct LowPassRow : LowPassOptions {
    bool cutoff_given = false;
};

LowPassRow low_pass_defaults(const Layer* layer) {
    LowPassRow o;
    o.cutoff = layer ? default_cutoff(*layer, o.unit) : 1;
    if (layer) o.calibration.method = default_method(layer->mesh);
    o.region.selected = has_selection(layer);
    return o;
}

void bind_low_pass(Parameters& p, LowPassRow& o) {
    bind_unit(p, o.unit);
    p.add("cutoff", &o.cutoff, "Cutoff",
          "Everything finer than this is removed: shorter waves, lower levels, levels with more vertices.")
        .at_least(0)
        .in("Band")
        .derived(o.cutoff_given);
    bind_softness(p, o.softness);
    bind_calibration(p, o.calibration);
    bind_region(p, o.region);
    bind_relative_to(p, o.relative_to);
    bind_pyramid(p, o.pyramid);
}

Result run_low_pass(const Layer& layer, const LowPassRow& row, Session& session) {
    LowPassOptions o = row;
    if (!row.cutoff_given) o.cutoff = default_cutoff(layer, o.unit);
    return low_pass(layer, o, session);
}

struct BandRow : BandOptions {
    GivenLimits given;
};

BandRow band_defaults(const Layer* layer) {
    BandRow o;
    o.band.coarsest = 1;
    if (layer) o.band = default_band(*layer, Unit::wavelength);
    if (layer) o.calibration.method = default_method(layer->mesh);
    o.region.selected = has_selection(layer);
    return o;
}

void bind_stop_band(Parameters& p, BandRow& o) {
    bind_band(p, o.band, o.given);
    bind_calibration(p, o.calibration);
    bind_region(p, o.region);
    bind_relative_to(p, o.relative_to);
    bind_pyramid(p, o.pyramid);
}

BandRow enhance_defaults(const Layer* layer) {
    BandRow o = band_defaults(layer);
    o.gain = 2;
    return o;
}

void bind_enhance(Parameters& p, BandRow& o) {
    bind_gain(p, o.gain);
    bind_stop_band(p, o);
}

Result run_band(const Layer& layer, const BandRow& row, Session& session) {
    BandOptions o = row;
    o.band = with_derived_limits(layer, o.band, row.given);
    return scale_band(layer, o, session);
}

/// The limits are there for the labels only.
struct EqualizerRow : EqualizerOptions {
    std::array<double, equalizer_bands + 1> limit{};
};

EqualizerRow equalizer_defaults(const Layer* layer) {
    EqualizerRow o;
    o.region.selected = has_selection(layer);
    if (layer) o.limit = equalizer_limits(*layer, o.pyramid);
    if (layer) o.calibration.method = default_method(layer->mesh);
    return o;
}

std::string band_label(const EqualizerRow& o, int i) {
    char text[96];
    if (o.limit[0] <= 0)
        std::snprintf(text, sizeof text, "Gain %d", i + 1);
    else if (i == 0)
        std::snprintf(text, sizeof text, "Gain 1: finer than %.3g", o.limit[1]);
    else if (i == equalizer_bands - 1)
        std::snprintf(text, sizeof text, "Gain %d: coarser than %.3g", i + 1, o.limit[i]);
    else
        std::snprintf(text, sizeof text, "Gain %d: %.3g to %.3g", i + 1, o.limit[i], o.limit[i + 1]);
    return text;
}

void bind_equalizer(Parameters& p, EqualizerRow& o) {
    for (int i = 0; i < equalizer_bands; ++i)
        p.add("gain_" + std::to_string(i + 1), &o.gain[i], band_label(o, i),
              "Factor for the structure of these wavelengths (mesh units): 1 leaves it, 0 removes it, 2 doubles it.")
            .slider(0, 4)
            .in("Bands, fine to coarse");
    bind_softness(p, o.softness);
    bind_calibration(p, o.calibration);
    bind_region(p, o.region);
    bind_relative_to(p, o.relative_to);
    bind_pyramid(p, o.pyramid);
}

Result run_equalizer(const Layer& layer, const EqualizerRow& options, Session& session) {
    return equalizer(layer, options, session);
}

UnsharpOptions unsharp_defaults(const Layer* layer) {
    UnsharpOptions o;
    o.region.selected = has_selection(layer);
    return o;
}

void bind_unsharp(Parameters& p, UnsharpOptions& o) {
    p.add("xi", &o.xi, "Strength",
          "1 changes nothing; 2 doubles what the relaxation takes away; between 0 and 1 smooths, 0 fully.")
        .slider(0, 10);
    p.add("iterations", &o.iterations, "Relaxation steps", "More steps reach coarser structure; each costs the same.")
        .between(1, 10000);
    bind_operator(p, o.op, "Relaxation");
    bind_region(p, o.region);
    bind_relative_to(p, o.relative_to);
    bind_features(p, o.features, o.feature_angle);
}

constexpr std::uint32_t reads = vertex_quality;

}  // namespace

const Plugin& table() {
    static const Plugin plugin{
        "FilterMultiresBand",
        {
            filter({"Multiresolution: Low Pass", "apply_coord_multires_low_pass",
                    std::string("Removes everything finer than a wavelength and keeps everything coarser, in one pass, "
                                "without shrinking the shape.<br>") +
                        cite_guskov,
                    MenuClass::smoothing, faces | closed_seams, reads, vertex_positions,
                    band_returns + moved_returns + change_returns},
                   low_pass_defaults, bind_low_pass, run_low_pass),
            filter(
                {"Multiresolution: Stop Band", "apply_coord_multires_stop_band",
                 std::string("Removes the structure between two wavelengths; finer engraving and the coarse shape stay."
                             "<br>") +
                     cite_guskov + cite_roy,
                 MenuClass::smoothing, faces | closed_seams, reads, vertex_positions,
                 band_returns + moved_returns + change_returns},
                band_defaults, bind_stop_band, run_band),
            filter(
                {"Multiresolution: Enhance Band", "apply_coord_multires_enhance",
                 std::string("Multiplies the structure between two wavelengths by a gain: brings out what is worn, or "
                             "weakens what disturbs.<br>") +
                     cite_guskov + cite_roy,
                 MenuClass::smoothing, faces | closed_seams, reads, vertex_positions,
                 band_returns + moved_returns + change_returns},
                enhance_defaults, bind_enhance, run_band),
            filter({"Multiresolution: Equalizer", "apply_coord_multires_equalizer",
                    std::string("Eight gains for eight bands of wavelengths from fine to coarse, given in the mesh's "
                                "unit. With all gains at 1 the mesh comes back unchanged.<br>") +
                        cite_guskov,
                    MenuClass::smoothing, faces | closed_seams, reads, vertex_positions,
                    band_returns + moved_returns + change_returns},
                   equalizer_defaults, bind_equalizer, run_equalizer),
            filter({"Multiresolution: Unsharp (Single Level)", "apply_coord_multires_unsharp",
                    std::string(
                        "Strengthens (or weakens) what some steps of relaxation would take away, without a pyramid. "
                        "Best for small meshes; scans with noise are better served by the bands.<br>") +
                        cite_guskov,
                    MenuClass::smoothing, faces | closed_seams, reads, vertex_positions, change_returns},
                   unsharp_defaults, bind_unsharp, unsharp),
        }};
    return plugin;
}

}  // namespace multires::plugin
