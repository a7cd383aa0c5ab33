#include "shared/bindings.h"
#include "shared/returns.h"

#include "filters/analysis/read_watermark.h"
#include "filters/shape/watermark.h"

// A hidden message in the shape, and reading it.

namespace multires::plugin {
namespace {

const char* const cite_watermark =
    "<br>See <i>Cox, Kilian, Leighton, Shamoon</i>, <b>\"Secure Spread Spectrum Watermarking for Multimedia\"</b>, "
    "IEEE TIP 1997.<br>See <i>Praun, Hoppe, Finkelstein</i>, <b>\"Robust Mesh Watermarking\"</b>, SIGGRAPH 1999.";

WatermarkOptions watermark_defaults(const Layer* layer) {
    WatermarkOptions o;
    o.region.selected = has_selection(layer);
    return o;
}

void bind_key(Parameters& p, std::string& key) {
    p.add("key", &key, "Key",
          "Any text. Who does not know it can neither read the message nor tell that there is one.");
}

void bind_watermark(Parameters& p, WatermarkOptions& o) {
    p.add("message", &o.message, "Message", "64 bits as 16 hexadecimal digits.");
    bind_key(p, o.key);
    p.add(
         "strength", &o.strength, "Strength",
         "Root mean square displacement, percent of the diagonal of the bounding box. More withstands more, and shows.")
        .between(0.001, 1);
    bind_region(p, o.region);
    bind_relative_to(p, o.relative_to);
}

ReadWatermarkOptions read_defaults(const Layer* /*layer*/) { return {}; }

void bind_read(Parameters& p, ReadWatermarkOptions& o) {
    p.add("original", &o.original, "Original", "The layer with the mesh before it was marked.");
    bind_key(p, o.key);
    p.add("expected", &o.expected, "Expected message",
          "16 hexadecimal digits to compare with, which is then reported as bit_errors; empty: none.");
}

const Returns watermark_returns{
    {"carriers", Type::integer, "",
     "Places that carry the mark: 280, fewer if there are fewer than 560 vertices, and then it may not be readable."},
    {"carrier_spacing", Type::real, "mesh units",
     "Distance of the places that carry the mark; its waves are about twice as long, and longer."},
};

const Returns read_returns{
    {"bits", Type::list, "", "The 64 bits of the message, the most significant first."},
    {"confidence", Type::list, "", "For each bit the probability that it is right, 0.5 to 1."},
    {"sure_bits", Type::integer, "", "How many of them are right with a probability of more than 0.99."},
    {"probability_unmarked", Type::real, "",
     "Probability that a mesh without a mark of this key would look as much like one, as estimated from wrong keys."},
    {"bit_errors", Type::integer, "", "With an expected message: the bits that differ.", false},
    {"carriers_seen", Type::real, "", "Share of the places that carry the mark that the mesh still has, 0 to 1."},
    {"scale", Type::real, "", "Factor that makes the mesh as large as the original."},
    {"smoothing", Type::real, "", "How many steps of smoothing made the original most like the mesh, 0 if none did."},
    {"rms_offset", Type::real, "mesh units",
     "Root mean square distance of the mesh from the original, once it was laid onto it."},
};

}  // namespace

const Plugin& table() {
    static const Plugin plugin{
        "FilterMultiresWatermark",
        {
            filter({"Multiresolution: Watermark", "apply_coord_multires_watermark",
                    std::string("Hides a message of 64 bits in the coefficients of a band of middle wavelengths, too "
                                "small and too smooth to be seen. Read Watermark finds it again, beside the original, "
                                "after motion, scaling, reordering, remeshing, simplification, noise, smoothing, "
                                "rounding or cropping.<br>") +
                        cite_watermark,
                    MenuClass::smoothing, faces, vertex_quality, vertex_positions, change_returns + watermark_returns},
                   watermark_defaults, bind_watermark, watermark),
            filter({"Multiresolution: Read Watermark", "compute_multires_watermark",
                    std::string("Reads the message that Watermark hid, beside the original in another layer; the mesh "
                                "may have been moved, turned and scaled. Returns how sure each bit is, and how "
                                "probable it is that there is no mark at all.<br>") +
                        cite_watermark,
                    MenuClass::measure, faces, none, none, read_returns},
                   read_defaults, bind_read, read_watermark),
        }};
    return plugin;
}

}  // namespace multires::plugin
