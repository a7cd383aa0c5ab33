#include "shared/bindings.h"
#include "shared/returns.h"

#include "filters/layers/adaptive.h"
#include "filters/layers/texture_seams.h"

#include <cmath>

// Threshold reconstruction.

namespace multires::plugin {
namespace {

/// A tenth of the faces where a target is chosen. Where texture coordinates jump, faces that straddle the seam would
/// show the texture torn: so they count.
AdaptiveOptions adaptive_defaults(const Layer* layer) {
    AdaptiveOptions o;
    if (!layer) return o;
    o.faces = static_cast<int>(layer->mesh.faces.size() / 10);
    o.vertices = static_cast<int>(layer->mesh.positions.size() / 10);
    o.texcoord.use = can_keep_seams(*layer);
    o.band = default_band(*layer, Unit::wavelength);
    return o;
}

Parameter& bind_use(Parameters& p, const std::string& name, DetailThreshold& t, const std::string& label,
                    const std::string& more = "") {
    return p.add("use_" + name, &t.use, "Use " + label, "Keep vertices for the sake of their " + label + "." + more)
        .in("Details");
}

void bind_threshold(Parameters& p, const std::string& name, DetailThreshold& t, const std::string& label,
                    const std::string& unit) {
    p.add(name + "_threshold", &t.threshold, "Threshold of " + label,
          "Vertices whose detail is at least this long are kept: " + unit +
              ". 0 keeps all. With a target other than the threshold it only says how the kinds of detail compare.")
        .at_least(0)
        .in("Details");
}

void bind_target(Parameters& p, AdaptiveOptions& o) {
    const char* group = "Target";
    p.add("target", Choice(o.target, {"threshold", "faces", "vertices", "RMS distance", "largest distance"}), "Target",
          "What decides how many vertices are kept: the thresholds as given; a number of faces or vertices; or a "
          "bound on the measured two-sided distance to the input, with as few vertices as are found.")
        .in(group);
    p.add("unit", Choice(o.unit, {"mesh units", "percent"}), "Unit of lengths",
          "Of the threshold of shape and of the error bound: mesh units, or percent of the diagonal of the bounding "
          "box (1 is 1 %).")
        .in(group);
    p.add("faces", &o.faces, "Faces", "Target faces: at most so many faces; the base may have more.")
        .at_least(0)
        .in(group)
        .derived();
    p.add("vertices", &o.vertices, "Vertices", "Target vertices: so many, not counting those in no face.")
        .at_least(0)
        .in(group)
        .derived();
    p.add("error", &o.error, "Error bound",
          "Targets RMS distance and largest distance: the bound, in the unit of lengths.")
        .at_least(0)
        .in(group);
}

void bind_adaptive(Parameters& p, AdaptiveOptions& o) {
    bind_target(p, o);
    bind_use(p, "geometry", o.geometry, "shape");
    bind_threshold(p, "geometry", o.geometry, "shape", "in the unit of lengths");
    bind_use(p, "color", o.color, "colour");
    bind_threshold(p, "color", o.color, "colour", "length of the difference in red, green, blue and alpha, 0 to 255");
    bind_use(p, "quality", o.quality, "quality");
    bind_threshold(p, "quality", o.quality, "quality", "in the measure of the vertex quality");
    bind_use(
        p, "texcoord", o.texcoord, "texture coordinates",
        " Seams of the texture stay seams: no face straddles them. On by default if there can be any, unless they meet "
        "at more than a twentieth of the vertices, which could not go then.")
        .derived();
    bind_threshold(p, "texcoord", o.texcoord, "texture coordinates",
                   "length of the difference in u and v, of wedges if there are any, of vertices otherwise");
    bind_use(p, "normal", o.normal, "normals");
    bind_threshold(p, "normal", o.normal, "normals", "degrees");
    p.add("criterion", Choice(o.criterion, {"area error", "local error", "detail"}), "Detail of shape",
          "Area error: what removing the vertex adds to the RMS distance of the surfaces; the fewest faces for an "
          "RMS distance. Local error: the distance it adds at the vertex, whatever the area; keeps small features. "
          "Detail: distance to where relaxation predicts the vertex (Roy).")
        .in("Details");
    p.add("region_of_interest", &o.region_of_interest, "Selection in full",
          "Keep selected vertices and faces as they are, and level of detail by the thresholds elsewhere.")
        .in("Target");
    p.add("fit", &o.fit, "Fit positions",
          "Move the vertices kept to where they fit the input best. The boundary and the selection kept in full "
          "stay where they are. If the target is a number or the RMS distance and the shape alone decides, vertices "
          "move while others are removed: less RMS distance in less time.")
        .in("Target");
    p.add("measure", &o.measure, "Measure the distance", "Report the two-sided distance to the input.").in("Target");
    const char* band = "Band";
    p.add("band_gain", &o.band_gain, "Gain of a band",
          "Applied to the input first: 0 removes the details between the two wavelengths below, 1 changes nothing.")
        .between(-1000, 1000)
        .advanced(band);
    p.add("finest", &o.band.finest, "Finest", "Fine limit of the band: wavelength in mesh units.")
        .at_least(0)
        .advanced(band)
        .derived();
    p.add("coarsest", &o.band.coarsest, "Coarsest", "Coarse limit of the band: wavelength in mesh units.")
        .at_least(0)
        .advanced(band)
        .derived();
    bind_operator(p, o.op, "Pyramid");
    p.add("base_vertices", &o.base_vertices, "Base vertices", "Vertices of the base mesh.")
        .at_least(4)
        .advanced("Pyramid");
    p.add("normal_limit", Angle{&o.normal_limit}, "Normal limit",
          "Degrees by which removing a vertex may turn a face at most.")
        .between(1, 180)
        .advanced("Pyramid");
    bind_features(p, o.features, o.feature_angle);
}

constexpr std::uint32_t reads = vertex_attributes | wedge_texcoord;

const Returns adaptive_returns{
    {"faces", Type::integer, "", "Faces of the new layer."},
    {"vertices", Type::integer, "", "Its vertices."},
    {"unreferenced_vertices", Type::integer, "", "Vertices without a face, which are kept."},
    {"base_faces", Type::integer, "", "Faces of the base mesh: no fewer can be had.", false},
    {"base_vertices", Type::integer, "", "Its vertices.", false},
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
            filter({"Multiresolution: Adaptive Reconstruction", "generate_multires_adaptive_reconstruction",
                    std::string(
                        "Makes a new layer that holds only the vertices whose detail exceeds a threshold, and all they "
                        "depend on: many where the surface, its colour, quality or texture changes, few elsewhere. The "
                        "threshold can also be found for a number of faces or vertices or an error bound. The custom "
                        "vertex attribute <i>source_vertex</i> holds the index of each vertex in the input.<br>") +
                        cite_roy,
                    MenuClass::remeshing, faces | closed_seams, reads, new_layer, adaptive_returns},
                   adaptive_defaults, bind_adaptive, adaptive_reconstruction),
        }};
    return plugin;
}

}  // namespace multires::plugin
