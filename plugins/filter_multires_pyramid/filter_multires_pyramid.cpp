#include "shared/bindings.h"
#include "shared/returns.h"

#include "filters/layers/difference.h"
#include "filters/layers/levels.h"
#include "filters/shape/band_filters.h"
#include "measure/measure.h"

// Filters that build a pyramid and show what is in it.

namespace multires::plugin {
namespace {

ComputePyramidOptions compute_defaults(const Layer* /*layer*/) { return {}; }

void bind_compute(Parameters& p, ComputePyramidOptions& o) { bind_pyramid(p, o.pyramid); }

/// With the level as a dialog can show it.
struct LevelRow : GenerateLevelOptions {
    int shown = automatic;
    static constexpr int automatic = -1;
};

/// A sphere about the middle, and a box half as large as the mesh's.
LevelRow level_defaults(const Layer* layer) {
    LevelRow o;
    if (!layer) return o;
    const Box box = bounding_box(layer->mesh.positions);
    o.centre = box.center();
    o.low = (box.low + o.centre) / 2, o.high = (box.high + o.centre) / 2;
    o.radius = box.diagonal() / 8;
    return o;
}

void bind_region_of_detail(Parameters& p, LevelRow& o) {
    const char* const group = "Region";
    p.add("detail_in", Choice(o.detail_in, {"nowhere", "selection", "box", "sphere"}), "All detail in",
          "A region that keeps all its vertices; the mesh gets coarser with the distance from it until it is that of "
          "the level. Nowhere: the level everywhere.")
        .in(group);
    p.add("growth", &o.growth, "Growth",
          "How fast it gets coarser: edges may be longer by so much of their distance from the region.")
        .at_least(0)
        .in(group);
    p.add("low", Point{&o.low}, "Box from", "The corner of the box with the smallest coordinates.").in(group).derived();
    p.add("high", Point{&o.high}, "Box to", "The opposite corner.").in(group).derived();
    p.add("centre", Point{&o.centre}, "Centre", "Of the sphere.").in(group).derived();
    p.add("radius", &o.radius, "Radius", "Of the sphere, mesh units.").at_least(0).in(group).derived();
}

void bind_level(Parameters& p, LevelRow& o) {
    p.add("level", &o.shown, "Level",
          "0 is the mesh itself; Build Pyramid lists the vertices of the others. -1: the level that comes nearest to a "
          "quarter of the vertices. A number beyond the last level is an error that names the last.")
        .at_least(LevelRow::automatic);
    p.add("vertices", &o.vertices, "Vertices",
          "More than 0: a mesh of exactly so many vertices, whatever the level; with a region, those around it are "
          "chosen by their distance.")
        .at_least(0);
    p.add("smoothed", &o.smoothed, "Smoothed positions",
          "Place the vertices where the coarse level of the pyramid has them (presmoothed) instead of where they "
          "are in the mesh. Of whole levels only.");
    bind_region_of_detail(p, o);
    bind_pyramid(p, o.pyramid);
}

Result run_level(const Layer& layer, const LevelRow& row, Session& session) {
    GenerateLevelOptions o = row;
    if (row.shown != LevelRow::automatic) o.level = row.shown;
    return generate_level(layer, o, session);
}

struct DetailRow : DetailOptions {
    GivenLimits given;
};

DetailRow detail_defaults(const Layer* layer) {
    DetailRow o;
    o.band.coarsest = 1;
    if (layer) o.band = default_band(*layer, Unit::wavelength);
    return o;
}

void bind_detail(Parameters& p, DetailRow& o) {
    bind_band(p, o.band, o.given);
    p.add("signed_normal", &o.signed_normal, "Signed, along the normal",
          "Store the part of the detail along the vertex normal, positive outwards, instead of its length.");
    bind_pyramid(p, o.pyramid);
}

Result run_detail(const Layer& layer, const DetailRow& row, Session& session) {
    DetailOptions o = row;
    o.band = with_derived_limits(layer, o.band, row.given);
    return detail_quality(layer, o, session);
}

DifferenceOptions difference_defaults(const Layer* layer) {
    DifferenceOptions o;
    if (layer) o.beyond = 0.001 * box_diagonal(*layer);
    return o;
}

void bind_difference(Parameters& p, DifferenceOptions& o) {
    p.add("layer", &o.layer, "Reference", "The layer that the distance is measured to: a surface, open or closed.");
    p.add("wavelength", &o.wavelength, "Wavelength",
          "Mesh units: differences that vary more finely over the surface, such as noise, are left out. 0 leaves in "
          "all.")
        .at_least(0);
    p.add("beyond", &o.beyond, "Tolerance", "Mesh units: the share of the surface that is farther away is reported.")
        .at_least(0)
        .derived();
    bind_pyramid(p, o.pyramid);
}

const Returns compute_returns{
    {"levels", Type::integer, "", "Number of the coarsest level; the finest is 0."},
    {"level", Type::list, "", "0, 1, ... to the coarsest."},
    {"vertices", Type::list, "", "Vertices of each level."},
    {"wavelength", Type::list, "mesh units", "Finest wave of each level: twice its mean edge length."},
    {"rms_detail", Type::list, "mesh units", "Root mean square of each level's details; 0 for the coarsest."},
    {"reconstruction_error", Type::real, "mesh units", "Largest distance of a vertex after all levels are added up."},
    {"duplicate_vertices", Type::integer, "", "Vertices at the place of another one."},
    {"degenerate_faces", Type::integer, "", "Faces with a vertex twice or without area."},
    {"duplicate_faces", Type::integer, "", "Faces with the vertices of another one."},
    {"non_manifold_edges", Type::integer, "", "Edges of more than two faces."},
    {"non_manifold_vertices", Type::integer, "", "Vertices whose faces do not form one fan."},
    {"boundary_edges", Type::integer, "", "Edges of one face."},
    {"boundary_loops", Type::integer, "", "Closed boundaries."},
    {"inconsistent_edges", Type::integer, "", "Edges whose two faces are turned differently."},
    {"components", Type::integer, "", "Parts that share no edge."},
};

const Returns level_returns{
    {"level", Type::integer, "", "The level."},
    {"vertices", Type::integer, "", "Its vertices."},
    {"faces", Type::integer, "", "Its faces."},
    {"wavelength", Type::real, "mesh units", "Twice its mean edge length."},
};

const Returns detail_returns{
    {"least_detail", Type::real, "mesh units", "Smallest value written to the vertex quality."},
    {"largest_detail", Type::real, "mesh units", "Largest value."},
    {"rms_detail", Type::real, "mesh units", "Root of their mean square."},
};

const Returns difference_returns{
    {"rms_difference", Type::real, "mesh units", "Root mean square of the difference over the surface."},
    {"mean_difference", Type::real, "mesh units", "Its mean: positive outside the reference, on the whole."},
    {"largest_difference", Type::real, "mesh units", "Largest value written to the vertex quality."},
    {"smallest_difference", Type::real, "mesh units", "Smallest value; negative inside."},
    {"share_beyond", Type::real, "", "Share of the area farther away than the tolerance, 0 to 1."},
    {"gains", Type::list, "", "With a wavelength: the factor of each level's details, finest first.", false},
    {"pyramid_reused", Type::boolean, "", "With a wavelength: the pyramid kept with the mesh was used.", false},
    {"locked_vertices", Type::integer, "", "With a wavelength: vertices at non-manifold edges or points.", false},
    {"unreferenced_vertices", Type::integer, "", "With a wavelength: vertices without a face.", false},
};

}  // namespace

const Plugin& table() {
    static const Plugin plugin{
        "FilterMultiresPyramid",
        {
            filter(
                {"Multiresolution: Build Pyramid", "compute_multires_pyramid",
                 std::string("Builds a pyramid of levels of resolution and keeps it with the mesh, so that the other "
                             "multiresolution filters answer at once while the mesh stays the same. The mesh is not "
                             "changed. Returned for each level: number of vertices, wavelength (twice the mean edge "
                             "length) and root mean square of the details; the largest error of the reconstruction; "
                             "and what is unusual in the mesh.<br>") +
                     cite_guskov + cite_roy,
                 MenuClass::measure, faces | closed_seams, none, none, compute_returns + pyramid_returns},
                compute_defaults, bind_compute, compute_pyramid),
            filter({"Multiresolution: Level as New Layer", "generate_multires_level",
                    std::string(
                        "Makes a new layer with the mesh of one level of the pyramid, or of any number of vertices: a "
                        "subset of the vertices with all their attributes. A region (the selection, a box or a sphere) "
                        "may keep all its detail, with ever larger faces around it. Faces of coarse levels may "
                        "straddle the seams of a texture; those of Adaptive Reconstruction do not. The custom vertex "
                        "attribute <i>source_vertex</i> holds the index of each in the input.<br>") +
                        cite_roy,
                    MenuClass::layer, faces | closed_seams, vertex_attributes, new_layer,
                    level_returns + pyramid_returns},
                   level_defaults, bind_level, run_level),
            filter(
                {"Multiresolution: Detail to Vertex Quality", "compute_scalar_multires_detail_per_vertex",
                 std::string("Stores in the vertex quality how much a band of scales adds to the shape at each vertex: "
                             "the distance to where the vertex would be without the band, or its signed part along the "
                             "normal, in mesh units.<br>") +
                     cite_guskov,
                 MenuClass::quality, faces | closed_seams, none, vertex_quality,
                 detail_returns + gains_returns + pyramid_returns},
                detail_defaults, bind_detail, run_detail),
            filter(
                {"Multiresolution: Difference to Layer", "compute_scalar_multires_difference_per_vertex",
                 std::string("Stores in the vertex quality how far each vertex is from another layer's surface, as "
                             "the two are placed in the document: positive outside, where that layer's normals point "
                             "to, negative inside. With a wavelength, only what is as coarse as that: deformation "
                             "without noise.<br>") +
                     cite_roy +
                     "<br>See <i>B&aelig;rentzen, Aan&aelig;s</i>, <b>\"Signed Distance Computation Using the Angle "
                     "Weighted Pseudonormal\"</b>, IEEE TVCG 2005.",
                 MenuClass::quality, faces | closed_seams, none, vertex_quality, difference_returns},
                difference_defaults, bind_difference, difference_to_layer),
        }};
    return plugin;
}

}  // namespace multires::plugin
