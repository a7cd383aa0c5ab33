#include "shared/bindings.h"
#include "shared/returns.h"

#include "filters/layers/adaptive.h"

#include <cmath>

// Threshold reconstruction.

namespace multires::plugin {
namespace {

/// A tenth of the faces where a target is chosen; the whole selection where there is one.
AdaptiveOptions adaptive_defaults(const Layer* layer) {
    AdaptiveOptions o;
    if (!layer) return o;
    o.faces = static_cast<int>(layer->mesh.faces.size() / 10);
    o.vertices = static_cast<int>(layer->mesh.positions.size() / 10);
    o.band = default_band(*layer, Unit::wavelength);
    return o;
}

void bind_threshold(Parameters& p, const std::string& name, DetailThreshold& t, const std::string& label,
                    const std::string& unit) {
    p.boolean(("use_" + name).c_str(), t.use,
              {"Use " + label, "Keep vertices for the sake of their " + label + ".", 0, 1, false, "Details"});
    p.real((name + "_threshold").c_str(), t.threshold,
           {"Threshold of " + label,
            "Vertices whose detail is at least this long are kept: " + unit +
                ". 0 keeps all. With a target other than the threshold it only says how the kinds of detail compare.",
            0, 1e30, false, "Details"});
}

void bind_target(Parameters& p, AdaptiveOptions& o) {
    const char* group = "Target";
    p.choice("target", o.target, {"threshold", "faces", "vertices", "RMS distance", "largest distance"},
             {"Target",
              "What decides how many vertices are kept: the thresholds as given; a number of faces or vertices; or a "
              "bound on the measured two-sided distance to the input, with as few vertices as are found.",
              0, 4, false, group});
    p.choice(
        "unit", o.unit, {"mesh units", "percent"},
        {"Unit of lengths",
         "Of the threshold of shape and of the error bound: mesh units, or percent of the diagonal of the bounding "
         "box (1 is 1 %).",
         0, 1, false, group});
    p.integer("faces", o.faces,
              {"Faces", "Target faces: at most so many faces; the base may have more.", 0, 2000000000, false, group});
    p.integer("vertices", o.vertices,
              {"Vertices", "Target vertices: so many, not counting those in no face.", 0, 2000000000, false, group});
    p.real("error", o.error,
           {"Error bound", "Targets RMS distance and largest distance: the bound, in the unit of lengths.", 0, 1e30,
            false, group});
}

void bind_adaptive(Parameters& p, AdaptiveOptions& o) {
    bind_target(p, o);
    bind_threshold(p, "geometry", o.geometry, "shape", "in the unit of lengths");
    bind_threshold(p, "color", o.color, "colour", "length of the difference in red, green, blue and alpha, 0 to 255");
    bind_threshold(p, "quality", o.quality, "quality", "in the measure of the vertex quality");
    bind_threshold(p, "texcoord", o.texcoord, "texture coordinates",
                   "length of the difference in u and v, of wedges if there are any, of vertices otherwise");
    bind_threshold(p, "normal", o.normal, "normals", "degrees");
    p.choice("criterion", o.criterion, {"area error", "local error", "detail"},
             {"Detail of shape",
              "Area error: what removing the vertex adds to the RMS distance of the surfaces; the fewest faces for an "
              "RMS distance. Local error: the distance it adds at the vertex, whatever the area; keeps small features. "
              "Detail: distance to where relaxation predicts the vertex (Roy).",
              0, 2, false, "Details"});
    p.boolean("region_of_interest", o.region_of_interest,
              {"Selection in full",
               "Keep selected vertices and faces as they are, and level of detail by the thresholds elsewhere.", 0, 1,
               false, "Target"});
    p.boolean("fit", o.fit,
              {"Fit positions",
               "Move the vertices kept to where they fit the input best. The boundary and the selection kept in full "
               "stay where they are.",
               0, 1, false, "Target"});
    p.boolean("measure", o.measure,
              {"Measure the distance", "Report the two-sided distance to the input.", 0, 1, false, "Target"});
    const char* band = "Band";
    p.real("band_gain", o.band_gain,
           {"Gain of a band",
            "Applied to the input first: 0 removes the details between the two wavelengths below, 1 changes nothing.",
            -1000, 1000, true, band});
    p.real("finest", o.band.finest,
           {"Finest", "Fine limit of the band: wavelength in mesh units.", 0, 1e30, true, band});
    p.real("coarsest", o.band.coarsest,
           {"Coarsest", "Coarse limit of the band: wavelength in mesh units.", 0, 1e30, true, band});
    bind_operator(p, o.op, "Pyramid");
    p.integer("base_vertices", o.base_vertices,
              {"Base vertices", "Vertices of the base mesh.", 4, 1000000000, true, "Pyramid"});
    p.real("normal_limit", o.normal_limit,
           {"Normal limit", "Degrees by which removing a vertex may turn a face at most.", 1, 180, true, "Pyramid"});
    bind_features(p, o.features, o.feature_angle);
}

constexpr std::uint32_t reads = vertex_quality | vertex_color | vertex_texcoord | wedge_texcoord;

const Returns adaptive_returns{
    {"faces", Type::integer, "", "Faces of the new layer."},
    {"vertices", Type::integer, "", "Its vertices."},
    {"unreferenced_vertices", Type::integer, "", "Vertices without a face, which are kept."},
    {"base_faces", Type::integer, "", "Faces of the base mesh: no fewer can be had."},
    {"base_vertices", Type::integer, "", "Its vertices."},
    {"*_threshold_used", Type::real, "unit of the threshold",
     "Threshold of each kind of detail in use, as given or as found for the target.", false},
    {"rms_distance", Type::real, "mesh units", "Root of the mean square of the two-sided distance to the input.",
     false},
    {"largest_distance", Type::real, "mesh units", "Largest two-sided distance to the input.", false},
    {"rms_distance_percent", Type::real, "percent of the box diagonal", "The same, relative.", false},
    {"largest_distance_percent", Type::real, "percent of the box diagonal", "The same, relative.", false},
};

}  // namespace

const Plugin& table() {
    static const Plugin plugin{
        "FilterMultiresAdaptive",
        {
            filter<AdaptiveOptions>(
                {"Multiresolution: Adaptive Reconstruction",
                 "generate_multires_adaptive_reconstruction",
                 std::string(
                     "Makes a new layer that holds only the vertices whose detail exceeds a threshold, and all they "
                     "depend on: many where the surface, its colour, quality or texture changes, few elsewhere. The "
                     "threshold can also be found for a number of faces or vertices or an error bound. The custom "
                     "vertex attribute <i>source_vertex</i> holds the index of each vertex in the input.<br>") +
                     cite_roy,
                 MenuClass::remeshing,
                 faces,
                 reads,
                 new_layer,
                 {},
                 {},
                 adaptive_returns},
                adaptive_defaults, bind_adaptive, adaptive_reconstruction),
        }};
    return plugin;
}

}  // namespace multires::plugin
