#include "shared/attribute_bindings.h"
#include "shared/bindings.h"
#include "shared/returns.h"

#include "filters/grid/grid_attributes.h"
#include "filters/grid/grid_band.h"
#include "filters/grid/grid_compress.h"
#include "filters/grid/grid_level.h"
#include "measure/measure.h"

#include <algorithm>
#include <cmath>

// Filters of triangular grids: terrains, range maps and other meshes whose inner vertices have six neighbours.

namespace multires::plugin {
namespace {

constexpr const char* cite_dreger = "<br>See <i>Dreger, Gross, Schlegel</i>, <b>\"Construction of Multiresolution "
                                    "Triangular B-Spline Surfaces using Hexagonal Filters\"</b>, ETH Z&uuml;rich 1999.";

constexpr std::uint32_t grid_attributes = vertex_color | vertex_quality | custom_attributes;

void bind_basis(Parameters& p, GridOptions& o) {
    p.add("basis", Choice(o.basis, {"linear", "quartic"}), "Basis",
          "Scaling functions and wavelets. Linear: continuous, of two triangles' reach. Quartic: curvature is "
          "continuous, too.")
        .in("Grid");
    p.add("levels", &o.levels, "Levels", "How many, at most; fewer on small grids. 0: down to about 4 by 4 points.")
        .between(0, 16)
        .in("Grid");
}

void bind_grid(Parameters& p, GridOptions& o) {
    p.add("channels", Choice(o.channels, {"positions", "heights"}), "Channels",
          "Positions: all three coordinates. Heights: only along the direction in which the surface leaves its plane "
          "most, z of a terrain.")
        .in("Grid");
    bind_basis(p, o);
}

ComputeGridOptions compute_defaults(const Layer*) { return {}; }
void bind_compute(Parameters& p, ComputeGridOptions& o) { bind_grid(p, o.grid); }

struct GridBandRow : GridBandOptions {
    GivenLimits given;
};

/// Waves of 2 to 8 times the finest, as for other bands; each level is an octave.
Band default_grid_band(const Layer& layer, Unit unit) {
    Band band = default_band(layer, unit);
    if (unit == Unit::level) band.finest = 1, band.coarsest = 3;
    return band;
}

GridBandRow band_defaults(const Layer* layer) {
    GridBandRow o;
    o.band.coarsest = 1;
    if (layer) o.band = default_grid_band(*layer, Unit::wavelength);
    o.region.selected = has_selection(layer);
    return o;
}

void bind_gains(Parameters& p, GridBandOptions& o, GivenLimits& given) {
    bind_gain(p, o.gain);
    bind_band(p, o.band, given);
    p.add("gains", &o.gains, "Gains of levels",
          "If not empty, in place of gain and limits: a factor for each level, finest first, separated by commas. "
          "Levels left out keep 1.")
        .in("Band");
}

void bind_grid_band(Parameters& p, GridBandRow& o) {
    bind_gains(p, o, o.given);
    bind_grid(p, o.grid);
    bind_region(p, o.region);
    bind_relative_to(p, o.relative_to);
}

Result run_band(const Layer& layer, const GridBandRow& row, Session& session) {
    GridBandOptions o = row;
    o.band = with_limits(o.band, row.given, default_grid_band(layer, o.band.unit));
    return grid_band(layer, o, session);
}

GridCompressOptions compress_defaults(const Layer* layer) {
    GridCompressOptions o;
    if (layer) o.error = std::max(1e-3 * std::sqrt(surface(layer->mesh.faces, layer->mesh.positions).area), 1e-300);
    o.region.selected = has_selection(layer);
    return o;
}

void bind_kept(Parameters& p, GridCompressOptions& o, const char* error) {
    p.add("keep_by", Choice(o.keep_by, {"share", "error"}), "Keep by", "What says how many coefficients are kept.");
    p.add("share", &o.share, "Share", "Coefficients kept, in percent of the number of vertices.").between(0, 100);
    p.add("error", &o.error, "Error", error).at_least(0).derived();
    p.add("oracle", Choice(o.oracle, {"magnitude", "pursuit"}), "Oracle",
          "How they are chosen. Magnitude: the largest, at once. Pursuit: those that explain most of what is left, "
          "with the best values for all of them; some 100 times slower, half the error.");
}

void bind_compress(Parameters& p, GridCompressOptions& o) {
    bind_kept(p, o, "How far vertices may be off, at most, mesh units; as few as do it are kept.");
    bind_grid(p, o.grid);
    bind_region(p, o.region);
}

/// What the rows of attributes share.
void bind_attributes(Parameters& p, AttributeChoice& what, bool& linear_light) {
    bind_color_and_quality(p, what);
    bind_custom(p, what).derived();
    bind_custom_names(p, what);
    bind_linear_light(p, linear_light);
}

/// The first of color, quality and custom that the layer has.
AttributeChoice chosen_of(const Layer* layer) {
    AttributeChoice choice = default_choice(layer);
    if (choice.texcoord || choice.wedge_texcoord) choice = AttributeChoice{true, false, false, false, false, ""};
    return choice;
}

struct GridAttributeBandRow : GridAttributeBandOptions {
    GivenLimits given;
};

GridAttributeBandRow attribute_band_defaults(const Layer* layer) {
    GridAttributeBandRow o;
    o.what = chosen_of(layer);
    static_cast<GridBandOptions&>(o.band) = band_defaults(layer);
    return o;
}

void bind_attribute_band(Parameters& p, GridAttributeBandRow& o) {
    bind_attributes(p, o.what, o.linear_light);
    bind_gains(p, o.band, o.given);
    bind_basis(p, o.band.grid);
    bind_region(p, o.band.region);
}

Result run_attribute_band(const Layer& layer, const GridAttributeBandRow& row, Session& session) {
    GridAttributeBandOptions o = row;
    o.band.band = with_limits(o.band.band, row.given, default_grid_band(layer, o.band.band.unit));
    return grid_attributes_band(layer, o, session);
}

GridAttributeCompressOptions attribute_compress_defaults(const Layer* layer) {
    GridAttributeCompressOptions o;
    o.what = chosen_of(layer);
    o.compress.error = default_attribute_error(layer);
    o.compress.region.selected = has_selection(layer);
    return o;
}

void bind_attribute_compress(Parameters& p, GridAttributeCompressOptions& o) {
    bind_attributes(p, o.what, o.linear_light);
    bind_kept(
        p, o.compress,
        "How far values may be off, at most, in units of the attribute (a colour as a vector of 0 to 255); as few "
        "as do it are kept.");
    bind_basis(p, o.compress.grid);
    bind_region(p, o.compress.region);
}

GridLevelOptions level_defaults(const Layer*) { return {}; }

void bind_level(Parameters& p, GridLevelOptions& o) {
    p.add("level", &o.level, "Level",
          "Of the control points: 0 is the grid, each level halves the number of points "
          "along each direction.")
        .at_least(0);
    p.add("refine", &o.refine, "Refine",
          "Steps of subdivision: 0 is the control mesh itself; as many as the level give the smooth surface with the "
          "grid's own vertices; up to three more are finer than the grid.")
        .at_least(0);
    p.add(
        "attributes", &o.attributes, "Attributes of the level",
        "Vertex colours, quality and custom attributes are transformed like the shape. Off: they are those of a vertex "
        "near.");
    bind_basis(p, o.grid);
}

GridEditOptions edit_defaults(const Layer* layer) {
    GridEditOptions o;
    o.region.selected = has_selection(layer);
    return o;
}

void bind_edit(Parameters& p, GridEditOptions& o) {
    p.add("edited", &o.edited, "Edited control mesh",
          "A layer made by Grid Level as Layer from the current one, without refinement, whose vertices were moved.");
    p.add(
        "attributes", &o.attributes, "Attributes follow",
        "Vertex colours, quality and custom attributes change where those of the control mesh were changed (painted), "
        "too. It must have been made with Attributes of the level.");
    bind_basis(p, o.grid);
    bind_region(p, o.region);
}

const Returns grids_returns{{"grids", Type::integer, "", "Grids that the layer consists of."}};

const Returns compute_returns{
    {"grids", Type::integer, "", "Grids that the layer consists of."},
    {"rows", Type::list, "", "Rows of each grid's box on the lattice, largest grid first."},
    {"columns", Type::list, "", "Columns of each."},
    {"vertices", Type::list, "", "Vertices of each."},
    {"holes", Type::list, "", "Holes of each: groups of faces missing inside."},
    {"loose_vertices", Type::integer, "", "Vertices of faces that belong to no grid; no filter moves them."},
    {"off_lattice_faces", Type::integer, "", "Faces that do not join three neighbours, as at corners of holes."},
    {"levels", Type::integer, "", "Levels of the largest grid."},
    {"wavelength", Type::list, "mesh units", "The finest wave of each level."},
    {"energy", Type::list, "square mesh units",
     "Energy of the details: seven types of wavelets of level 0, then those of level 1, ..."},
    {"reconstruction_error", Type::real, "mesh units", "The most that a coordinate changes by analysis and synthesis."},
};

const Returns compress_returns{
    {"kept_coefficients", Type::integer, "", "Coefficients that were kept."},
    {"kept_share", Type::real, "percent", "The same, of the vertices of grids."},
    {"rms_error", Type::real, "mesh units", "Root of the mean square distance of vertices from where they were."},
    {"largest_error", Type::real, "mesh units", "The largest distance."},
    {"error_energy", Type::real, "percent", "Energy of the error, of that of the samples."},
};

const Returns attribute_compress_returns = sometimes({
    {"*_kept_coefficients", Type::integer, "", "Coefficients that were kept."},
    {"*_kept_share", Type::real, "percent", "The same, of the vertices of grids."},
    {"*_rms_error", Type::real, "units of the attribute", "Root of the mean square error before colours are clamped."},
    {"*_largest_error", Type::real, "units of the attribute", "The largest error."},
    {"*_error_energy", Type::real, "percent", "Energy of the error, of that of the samples."},
});

const Returns level_returns{
    {"vertices", Type::integer, "", "Vertices of the new layer."},
    {"faces", Type::integer, "", "Its faces."},
};

const Returns edit_returns{{"level", Type::integer, "", "The level that the edited layer is a control mesh of."}};

}  // namespace

const Plugin& table() {
    static const Plugin plugin{
        "FilterMultiresGrid",
        {
            filter({"Multiresolution: Compute Grid", "compute_multires_grid",
                    std::string("Finds out whether the layer is a triangular grid (all inner vertices with six "
                                "neighbours: a terrain, a range map), how large it is, and how much energy the seven "
                                "types of box-spline wavelets have at each level.<br>") +
                        cite_dreger,
                    MenuClass::measure, faces, none, none, compute_returns},
                   compute_defaults, bind_compute, compute_grid),
            filter({"Multiresolution: Grid Band", "apply_coord_multires_grid_band",
                    std::string("Weakens, removes or strengthens detail of some sizes on a triangular grid, by "
                                "box-spline wavelets that prefer none of its directions.<br>") +
                        cite_dreger,
                    MenuClass::smoothing, faces, vertex_quality, vertex_positions,
                    grids_returns + gains_returns + change_returns},
                   band_defaults, bind_grid_band, run_band),
            filter({"Multiresolution: Grid Compression", "apply_coord_multires_grid_compress",
                    std::string("Replaces a triangular grid by what a few of its box-spline wavelets give: a share "
                                "of them, or as few as an error bound allows.<br>") +
                        cite_dreger,
                    MenuClass::smoothing, faces, vertex_quality, vertex_positions, compress_returns + change_returns},
                   compress_defaults, bind_compress, grid_compress),
            filter({"Multiresolution: Grid Level as Layer", "generate_multires_grid_level",
                    std::string("Makes a new layer of the control points of a level of a triangular grid, or of the "
                                "smooth surface that they give, at a level as fine as wanted.<br>") +
                        cite_dreger,
                    MenuClass::layer, faces, grid_attributes, new_layer, level_returns},
                   level_defaults, bind_level, generate_grid_level),
            filter({"Multiresolution: Follow Edited Grid Level", "apply_coord_multires_grid_edit",
                    std::string("Lets a triangular grid follow its edited control mesh: make one with Grid Level as "
                                "Layer, move its vertices, and the surface moves with them and keeps its "
                                "detail.<br>") +
                        cite_dreger,
                    MenuClass::remeshing, faces, grid_attributes, vertex_positions | grid_attributes,
                    edit_returns + change_returns + attribute_returns},
                   edit_defaults, bind_edit, grid_edit),
            filter({"Multiresolution: Filter Attributes by Grid Band", "apply_attributes_multires_grid_band",
                    std::string("Weakens, removes or strengthens detail of some sizes of vertex colours, quality and "
                                "custom attributes on a triangular grid, by box-spline wavelets. The geometry stays as "
                                "it is.<br>") +
                        cite_dreger,
                    MenuClass::smoothing, faces, grid_attributes, grid_attributes,
                    grids_returns + gains_returns + attribute_returns},
                   attribute_band_defaults, bind_attribute_band, run_attribute_band),
            filter(
                {"Multiresolution: Compress Attributes on Grid", "apply_attributes_multires_grid_compress",
                 std::string("Replaces vertex colours, quality and custom attributes on a triangular grid by what a "
                             "few box-spline wavelets give: a share of them, or as few as an error bound allows. The "
                             "geometry stays as it is.<br>") +
                     cite_dreger,
                 MenuClass::smoothing, faces, grid_attributes, grid_attributes,
                 attribute_compress_returns + attribute_returns},
                attribute_compress_defaults, bind_attribute_compress, grid_attributes_compress),
        }};
    return plugin;
}

}  // namespace multires::plugin
