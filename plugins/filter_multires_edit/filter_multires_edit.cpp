#include "shared/bindings.h"
#include "shared/returns.h"

#include "filters/editing/bands.h"
#include "filters/editing/move_region.h"
#include "filters/editing/smooth_base.h"
#include "filters/editing/transfer_detail.h"
#include "filters/editing/transfer_edit.h"
#include "measure/measure.h"

#include <algorithm>
#include <cmath>

// Filters that change the coarse shape and let the detail follow.

namespace multires::plugin {
namespace {

/// The side of a square as large as the surface, which turns with the mesh, as its box does not.
double size_of(const Layer& layer) { return std::sqrt(surface(layer.mesh.faces, layer.mesh.positions).area); }

TransferEditOptions transfer_edit_defaults(const Layer* layer) {
    TransferEditOptions o;
    o.region.selected = has_selection(layer);
    o.soft_border = layer ? 0.02 * size_of(*layer) : 1;
    return o;
}

void bind_transfer_edit(Parameters& p, TransferEditOptions& o) {
    p.add("edited", &o.edited, "Edited proxy", "The coarse mesh near the current one, after it was edited.");
    p.add(
        "before", &o.before, "Proxy before",
        "The coarse mesh before it was edited, with the same vertices and faces in the same order. The same layer as "
        "the edited proxy if there is none: that one is then taken for a level of the current layer or, if it is none "
        "(remeshed, sculpted), a level is wrapped onto it.");
    p.add(
        "details", Choice(o.details, {"multiresolution", "single resolution", "none"}), "Details",
        "What becomes of detail finer than the proxy. Multiresolution: it turns and stretches with the surface. Single "
        "resolution: it keeps its direction in space. None: it is left out.");
    p.add("gain", &o.gain, "Detail gain", "Factor of the detail finer than the proxy; 1 is as it is.").slider(0, 4);
    p.add(
        "encoding", Choice(o.encoding, {"gradient", "frames", "phong"}), "Encoding",
        "Gradient: the proxy's turning and stretching is applied to the gradients of the surface, which is then put "
        "together by one linear solve; the most exact. Frames: a level of the pyramid moves, and details in frames of "
        "coarser levels follow. Phong: a smooth base moves, and details along smooth fields of normals follow.");
    p.add("bands", &o.bands, "Bands",
          "Phong only: 1 measures heights over the proxy itself; 2 to 8 put a smooth base of as many vertices as the "
          "proxy has and that many bands less one over it.")
        .between(1, most_bands);
    bind_region(p, o.region);
    p.add("soft_border", &o.soft_border, "Soft border",
          "Only on selection: distance from the border of the selection, mesh units, at which it takes full effect; "
          "0 is a sharp border.")
        .at_least(0)
        .in("Region")
        .derived();
    bind_pyramid(p, o.pyramid);
}

int default_base_vertices(const Layer& layer, const PyramidOptions& pyramid, int share) {
    const int all = static_cast<int>(layer.mesh.positions.size());
    return std::min(all, std::max({all / share, 4 * pyramid.hierarchy.base_vertices, 4}));
}

SmoothBaseOptions base_defaults(const Layer* layer) {
    SmoothBaseOptions o;
    if (layer) o.vertices = default_base_vertices(*layer, o.pyramid, 20);
    return o;
}

void bind_base(Parameters& p, SmoothBaseOptions& o) {
    p.add("vertices", &o.vertices, "Vertices kept",
          "How many vertices stay where they are. Fewer give a smoother base; waves longer than a few of their "
          "distances are left.")
        .at_least(1)
        .derived();
    bind_pyramid(p, o.pyramid);
}

FalloffOptions falloff_defaults(const Layer* layer) {
    FalloffOptions o;
    if (layer) o.falloff = 0.05 * size_of(*layer);
    return o;
}

void bind_falloff(Parameters& p, FalloffOptions& o) {
    p.add("falloff", &o.falloff, "Falloff",
          "How far around the selection the surface follows, along it, mesh units. Beyond it nothing moves.")
        .at_least(0)
        .derived();
}

MoveRegionOptions move_region_defaults(const Layer* layer) {
    MoveRegionOptions o;
    o.between = falloff_defaults(layer);
    if (!layer) return o;
    const bool some = !layer->selected_vertex.empty();
    Vec3 sum = Vec3::Zero();
    double count = 0;
    for (std::size_t v = 0; v < layer->mesh.positions.size(); ++v)
        if (!some || layer->selected_vertex[v]) sum += layer->mesh.positions[v], ++count;
    if (count > 0) o.pivot = sum / count;
    return o;
}

void bind_move_region(Parameters& p, MoveRegionOptions& o) {
    bind_falloff(p, o.between);
    p.add("translation", Point{&o.translation}, "Translation", "Where to the selection moves: x, y and z, mesh units.");
    p.add("angle", Angle{&o.angle}, "Angle",
          "Degrees by which the selection turns about the axis, counter-clockwise seen "
          "from its tip.")
        .slider(-180, 180);
    p.add("axis", Direction{&o.axis}, "Axis", "Direction of the axis that the selection turns about.");
    p.add("pivot", Point{&o.pivot}, "Pivot",
          "The point that the axis passes through and that scale starts from. By "
          "default the middle of the selected vertices.")
        .derived();
    p.add("scale", &o.scale, "Scale", "Factor of the selection's size; 1 leaves it.").between(0.01, 100);
    p.add("details_follow", &o.details_follow, "Details follow",
          "Detail finer than the falloff turns with the surface around it. Otherwise every vertex moves on its own.");
    p.add("store_falloff", &o.store_falloff, "Falloff to quality",
          "Store the share of the motion that each vertex gets in the vertex quality.");
    bind_pyramid(p, o.pyramid);
}

BandsOptions bands_defaults(const Layer* layer) {
    BandsOptions o;
    o.region.selected = has_selection(layer);
    o.gain[1] = 2;
    if (layer) o.vertices = default_base_vertices(*layer, o.pyramid, 50);
    return o;
}

void bind_bands(Parameters& p, BandsOptions& o) {
    for (std::size_t k = 0; k < o.gain.size(); ++k) {
        const std::string number = std::to_string(k + 1);
        p.add("gain_" + number, &o.gain[k], "Gain " + number,
              "Factor of the detail of band " + number + (k == 0 ? ", the finest" : "") +
                  ". There are as many bands of detail as bands less one.")
            .slider(0, 4);
    }
    p.add("bands", &o.bands, "Bands", "How many bands there are, the smooth base among them.")
        .between(2, most_bands)
        .in("Bands");
    p.add("levels", Choice(o.levels, {"ratio", "edge length", "equal detail"}), "Levels",
          "How the bases follow each other. Ratio: by a constant ratio of the vertices they keep. Edge length: by one "
          "of the mean edge lengths of these. Equal detail: so that all bands have about the same detail.")
        .in("Bands");
    p.add("vertices", &o.vertices, "Vertices of the base",
          "How many vertices the coarsest base keeps. Fewer leave more to the bands.")
        .at_least(1)
        .advanced("Bands")
        .derived();
    bind_region(p, o.region);
    bind_relative_to(p, o.relative_to);
    bind_pyramid(p, o.pyramid);
}

TransferDetailOptions transfer_detail_defaults(const Layer* layer) {
    TransferDetailOptions o;
    o.region.selected = has_selection(layer);
    if (layer) o.largest_distance = 0.15 * size_of(*layer);
    return o;
}

void bind_transfer_detail(Parameters& p, TransferDetailOptions& o) {
    p.add("layer", &o.layer, "Detail from",
          "The layer that has the detail: a scan near the current layer, or a copy of the current one that was "
          "sculpted.");
    p.add("use", Choice(o.use, {"apply", "store", "apply stored"}), "Use",
          "Apply: the current layer takes the detail over. Store: the detail becomes a custom attribute of the current "
          "layer, points in the frames of its vertices, and nothing moves. Apply stored: the current layer takes over "
          "what "
          "that attribute holds.");
    p.add("attribute", &o.attribute, "Attribute", "Name of the custom attribute that stores the detail.");
    p.add("gain", &o.gain, "Detail gain", "Factor of the detail; 1 brings vertices onto the other layer.").slider(0, 4);
    p.add("largest_distance", &o.largest_distance, "Largest distance",
          "How far along its normal, on either side, a vertex looks for the other layer, mesh units.")
        .at_least(0)
        .derived();
    p.add("finest", &o.finest, "Finest", "Leave out detail of waves shorter than that, mesh units; 0 leaves none out.")
        .at_least(0);
    p.add("coarsest", &o.coarsest, "Coarsest",
          "Leave out detail of waves longer than that, mesh units; 0 leaves none out.")
        .at_least(0);
    bind_region(p, o.region);
    bind_pyramid(p, o.pyramid);
}

constexpr const char* cite_vorsatz = "<br>See <i>Vorsatz, Kobbelt</i>, <b>\"Robust Multi-Band Detail Encoding for "
                                     "Triangular Meshes of Arbitrary Connectivity\"</b>, VMV 1999.";

const Returns transfer_edit_returns{
    {"way", Type::integer, "",
     "What the edited proxy was compared with: 1 a level of the current layer, 2 the proxy before, 3 a "
     "level that was wrapped onto it."},
    {"proxy_distance", Type::real, "mesh units", "Root mean square distance of the vertices to the proxy before."},
    {"folded_faces", Type::integer, "",
     "Faces that lie the other way round than the motion of the proxy near them would have it."},
};

const Returns base_point_returns{
    {"border_points", Type::integer, "", "Base points on the boundary, where the search left the surface."},
    {"nearest_points", Type::integer, "", "Base points that are the nearest, where no normal goes through the vertex."},
};

const Returns bands_returns{
    {"vertices_kept", Type::list, "", "Vertices that each base keeps, finest first."},
    {"band_detail", Type::list, "mesh units", "Root mean square length of the details of each band, finest first."},
};

const Returns transfer_detail_returns{
    {"rms_detail", Type::real, "mesh units", "Root mean square length of the detail, with limits and gain."},
};

const Returns vertices_without_returns{
    {"vertices_without", Type::integer, "", "Vertices that meet no other layer: they follow their neighbours."},
};

const Returns falloff_returns{
    {"vertices_inside", Type::integer, "", "Vertices of the selection."},
    {"vertices_between", Type::integer, "", "Vertices between it and what is out of reach."},
};

const Returns base_returns{
    {"vertices_kept", Type::integer, "", "Vertices that stay where they are."},
    {"rms_displacement", Type::real, "mesh units", "Root of the mean square of the ways of all vertices to the base."},
    {"largest_displacement", Type::real, "mesh units", "The longest of these ways."},
    {"solver_steps", Type::integer, "", "Steps of conjugate gradients."},
};

}  // namespace

const Plugin& table() {
    static const Plugin plugin{
        "FilterMultiresEdit",
        {
            filter(
                {"Multiresolution: Follow Edited Layer", "apply_coord_multires_transfer_edit",
                 std::string("Lets the current layer, a scan say, follow the edit of a coarse mesh near it: export "
                             "a decimated copy or a level, change it in any editor, import it, and the scan changes "
                             "with it and keeps its detail, colours and texture. An edit that changes nothing leaves "
                             "every vertex exactly where it is.<br>") +
                     cite_guskov + cite_vorsatz,
                 MenuClass::remeshing, faces | closed_seams, vertex_quality, vertex_positions,
                 transfer_edit_returns + sometimes(bands_returns + base_point_returns) + sometimes(pyramid_returns) +
                     change_returns},
                transfer_edit_defaults, bind_transfer_edit, transfer_edit),
            filter({"Multiresolution: Move Region", "apply_coord_multires_displace",
                    std::string("Turns, scales and moves the selected part of a layer; the surface around it follows "
                                "smoothly up to a distance along the surface, and its detail turns with it.<br>") +
                        cite_guskov,
                    MenuClass::remeshing, faces | closed_seams, none, vertex_positions | vertex_quality,
                    change_returns},
                   move_region_defaults, bind_move_region, move_region),
            filter({"Multiresolution: Falloff to Quality", "compute_scalar_multires_falloff_per_vertex",
                    std::string("Stores in the vertex quality a smooth function on the surface that is 1 on the "
                                "selection and 0 beyond a distance from it: the share of the motion that Move Region "
                                "gives each vertex, and a mask for the other filters.<br>") +
                        cite_guskov,
                    MenuClass::quality, faces | closed_seams, none, vertex_quality, falloff_returns},
                   falloff_defaults, bind_falloff, falloff_quality),
            filter(
                {"Multiresolution: Smooth Base as Layer", "generate_multires_base",
                 std::string("Makes a new layer with the same vertices and faces, the smooth surface through some of "
                             "them: those that the pyramid keeps longest stay, the others go where the bending energy "
                             "is least. To be edited and followed, or to take detail from.<br>") +
                     cite_vorsatz,
                 MenuClass::layer, faces | closed_seams, none, new_layer, base_returns + pyramid_returns},
                base_defaults, bind_base, generate_base),
            filter({"Multiresolution: Multiband Edit", "apply_coord_multires_bands",
                    std::string("Splits the surface into a smooth base and bands of detail over one another, and puts "
                                "it together with a gain for each band. Details are heights over the next coarser "
                                "shape, along a field of normals without a jump, so they follow what coarser bands "
                                "do.<br>") +
                        cite_vorsatz,
                    MenuClass::remeshing, faces | closed_seams, vertex_quality, vertex_positions,
                    bands_returns + base_point_returns + pyramid_returns + change_returns},
                   bands_defaults, bind_bands, apply_bands),
            filter(
                {"Multiresolution: Detail from Layer", "transfer_coord_multires_detail",
                 std::string("Brings the detail of another layer, a scan say, onto the current one: its remesh, a "
                             "smooth or another shape nearby. Or stores it as a custom attribute that can be applied "
                             "later, to the same layer in another shape, as often and as strongly as wanted.<br>") +
                     cite_vorsatz,
                 MenuClass::remeshing, faces | closed_seams, vertex_quality | custom_attributes,
                 vertex_positions | custom_attributes,
                 transfer_detail_returns + sometimes(vertices_without_returns) + sometimes(pyramid_returns) +
                     sometimes(change_returns)},
                transfer_detail_defaults, bind_transfer_detail, transfer_detail),
        }};
    return plugin;
}

}  // namespace multires::plugin
