#include "shared/bindings.h"
#include "shared/returns.h"

#include "filters/editing/move_region.h"
#include "filters/editing/smooth_base.h"
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
        "encoding", Choice(o.encoding, {"gradient", "frames"}), "Encoding",
        "Gradient: the proxy's turning and stretching is applied to the gradients of the surface, which is then put "
        "together by one linear solve; the most exact. Frames: a level of the pyramid moves, and details in frames of "
        "coarser levels follow.");
    bind_region(p, o.region);
    p.add("soft_border", &o.soft_border, "Soft border",
          "Only on selection: distance from the border of the selection, mesh units, at which it takes full effect; "
          "0 is a sharp border.")
        .at_least(0)
        .in("Region")
        .derived();
    bind_pyramid(p, o.pyramid);
}

SmoothBaseOptions base_defaults(const Layer* layer) {
    SmoothBaseOptions o;
    if (layer) {
        const int all = static_cast<int>(layer->mesh.positions.size());
        o.vertices = std::min(all, std::max({all / 20, 4 * o.pyramid.hierarchy.base_vertices, 4}));
    }
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
                 MenuClass::remeshing, faces, vertex_quality, vertex_positions,
                 transfer_edit_returns + sometimes(pyramid_returns) + change_returns},
                transfer_edit_defaults, bind_transfer_edit, transfer_edit),
            filter({"Multiresolution: Move Region", "apply_coord_multires_displace",
                    std::string("Turns, scales and moves the selected part of a layer; the surface around it follows "
                                "smoothly up to a distance along the surface, and its detail turns with it. Without a "
                                "selection the whole layer moves.<br>") +
                        cite_guskov,
                    MenuClass::remeshing, faces, none, vertex_positions | vertex_quality, change_returns},
                   move_region_defaults, bind_move_region, move_region),
            filter({"Multiresolution: Falloff to Quality", "compute_scalar_multires_falloff_per_vertex",
                    std::string("Stores in the vertex quality a smooth function on the surface that is 1 on the "
                                "selection and 0 beyond a distance from it: the share of the motion that Move Region "
                                "gives each vertex, and a mask for the other filters.<br>") +
                        cite_guskov,
                    MenuClass::quality, faces, none, vertex_quality, falloff_returns},
                   falloff_defaults, bind_falloff, falloff_quality),
            filter(
                {"Multiresolution: Smooth Base as Layer", "generate_multires_base",
                 std::string("Makes a new layer with the same vertices and faces, the smooth surface through some of "
                             "them: those that the pyramid keeps longest stay, the others go where the bending energy "
                             "is least. To be edited and followed, or to take detail from.<br>") +
                     cite_vorsatz,
                 MenuClass::layer, faces, none, new_layer, base_returns + pyramid_returns},
                base_defaults, bind_base, generate_base),
        }};
    return plugin;
}

}  // namespace multires::plugin
