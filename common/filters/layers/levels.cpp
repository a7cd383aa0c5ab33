#include "filters/layers/levels.h"

#include "filters/layers/level_region.h"
#include "hierarchy/refinement.h"
#include "measure/measure.h"
#include "mesh/validation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace multires {
namespace {

/// Levels the report has room for: all, or a selection when there is one per vertex.
std::vector<std::size_t> levels_to_show(std::size_t count) {
    std::vector<std::size_t> shown;
    const std::size_t stride = std::max<std::size_t>(1, count / 64);
    for (std::size_t k = 0; k < count; k += stride) shown.push_back(k);
    if (shown.back() != count - 1) shown.push_back(count - 1);
    return shown;
}

void report_counts(const InputCounts& c, Report& report) {
    report.add("duplicate_vertices", static_cast<int>(c.duplicate_vertices));
    report.add("degenerate_faces", static_cast<int>(c.degenerate_faces + c.zero_area_faces));
    report.add("duplicate_faces", static_cast<int>(c.duplicate_faces));
    report.add("non_manifold_edges", static_cast<int>(c.non_manifold_edges));
    report.add("non_manifold_vertices", static_cast<int>(c.non_manifold_vertices));
    report.add("boundary_edges", static_cast<int>(c.boundary_edges));
    report.add("boundary_loops", static_cast<int>(c.boundary_loops));
    report.add("inconsistent_edges", static_cast<int>(c.inconsistent_edges));
    report.add("components", static_cast<int>(c.components));
}

/// The first `count` places, which are those of a level or lie between it and the next.
struct Cut {
    std::size_t level = 0;
    Index count = 0;
};

Cut given_level(const Hierarchy& h, int level) {
    const int last = static_cast<int>(h.levels.size());
    require(level >= 0 && level <= last,
            "level must be between 0 and " + std::to_string(last) + ", the number of levels of this mesh");
    return {static_cast<std::size_t>(level), h.size[level]};
}

Cut automatic_level(const Hierarchy& h, bool whole_levels) {
    const Index always = h.isolated + h.beside;
    const auto share = [&](Index count) {  // of the vertices that may go
        return static_cast<double>(count - always) / std::max<Index>(1, h.vertices() - always);
    };
    Cut best{0, h.size[0]};
    const auto off = [&](Index count) { return std::abs(std::log(std::max(share(count), 1e-9) / 0.25)); };
    const auto consider = [&](std::size_t level, Index count) {
        if (off(count) < off(best.count)) best = {level, count};
    };
    for (std::size_t k = 0; k < h.size.size(); ++k) consider(k, h.size[k]);
    if (whole_levels || (share(best.count) >= 0.2 && share(best.count) <= 1 / 3.0)) return best;
    for (std::size_t k = 0; k < h.levels.size(); ++k)
        for (const Index row : h.levels[k].cuts) consider(k, h.odd.vertex(row));
    return best;
}

/// So many vertices: the level is the finest that is not larger.
Cut given_count(const Hierarchy& h, int count) {
    require(count >= h.size.back() && count <= h.vertices(), "vertices must be between " +
                                                                 std::to_string(h.size.back()) + " and " +
                                                                 std::to_string(h.vertices()) + " for this mesh, or 0");
    std::size_t level = 0;
    while (h.size[level] > count) ++level;
    return {level, count};
}

Cut cut_of(const Hierarchy& h, const GenerateLevelOptions& options) {
    if (options.vertices > 0) return given_count(h, options.vertices);
    return options.level ? given_level(h, *options.level) : automatic_level(h, options.smoothed);
}

/// The mesh of the places kept, in their order.
DerivedMesh derived_mesh(const Hierarchy& h, const Faces& faces, const std::vector<std::uint8_t>& kept) {
    LevelMesh mesh = mesh_of_set(h, faces, kept);
    DerivedMesh derived;
    Array<Index> number(kept.size(), -1);
    for (std::size_t p = 0; p < kept.size(); ++p) {
        if (!kept[p]) continue;
        number[p] = static_cast<Index>(derived.source_vertex.size());
        derived.source_vertex.push_back(h.order[p]);
    }
    for (Face& f : mesh.faces) f = {number[f[0]], number[f[1]], number[f[2]]};
    derived.faces = std::move(mesh.faces);
    derived.source_face = std::move(mesh.source_face);
    return derived;
}

double wavelength_of(const DerivedMesh& mesh, const Positions& input) {
    Positions at;
    for (const Index v : mesh.source_vertex) at.push_back(input[v]);
    return 2 * mean_edge_length(mesh.faces, at);
}

}  // namespace

Result compute_pyramid(const Layer& layer, const ComputePyramidOptions& options, Session& session) {
    Result result;
    require_usable(layer.mesh);
    InputCounts counts = count_input(layer.mesh, 0);  // first: it needs as much memory as a part of the pyramid
    const auto pyramid =
        pyramid_of(layer, options.pyramid, session.pyramids, session.progress, result.report, session.let_mesh_go);
    const bool gone = layer.mesh.positions.empty();
    const auto position = [&](Index v) { return gone ? session.position(v) : layer.mesh.positions[v]; };
    counts.non_manifold_vertices = pyramid->hierarchy().irregular;
    const std::vector<LevelInfo>& levels = pyramid->levels();
    std::vector<double> level, vertices, wavelength, rms_detail;
    result.report.say("level     vertices  wavelength    RMS detail");
    for (const std::size_t k : levels_to_show(levels.size())) {
        level.push_back(static_cast<double>(k));
        vertices.push_back(levels[k].vertices);
        wavelength.push_back(levels[k].wavelength);
        rms_detail.push_back(levels[k].rms_detail);
        char line[96];
        std::snprintf(line, sizeof line, "%5zu %12d  %-12.6g  %-12.6g", k, levels[k].vertices, levels[k].wavelength,
                      levels[k].rms_detail);
        result.report.say(line);
    }
    session.progress.report(0.95, "Checking the reconstruction");
    result.report.add("levels", static_cast<int>(levels.size() - 1));
    result.report.add("level", level);
    result.report.add("vertices", vertices);
    result.report.add("wavelength", wavelength, "mesh units");
    result.report.add("rms_detail", rms_detail, "mesh units");
    result.report.add("reconstruction_error", pyramid->reconstruction_error(position), "mesh units");
    report_counts(counts, result.report);
    return result;
}

Result generate_level(const Layer& layer, const GenerateLevelOptions& options, Session& session) {
    const bool region = options.detail_in != DetailIn::nowhere;
    require(options.vertices >= 0, "vertices must be 0 or more");
    require(!options.smoothed || (!region && options.vertices == 0),
            "smoothed: positions are those of whole levels, without a number of vertices or a region");
    Result result;
    const auto pyramid = pyramid_of(layer, options.pyramid, session, result.report);  // checks the mesh, too
    const std::vector<double> distance = region ? region_distance(layer, options) : std::vector<double>();
    const Hierarchy& h = pyramid->hierarchy();
    require(h.lattice.empty() || (!region && options.vertices == 0),
            "scheme: levels of grids are octaves; a number of vertices or a region needs another scheme");
    const Cut cut = cut_of(h, options);
    const bool whole = !region && cut.count == h.size[cut.level];
    std::vector<std::uint8_t> kept(h.vertices(), 0);
    if (region)
        kept = level_of_region(h, layer.mesh.positions, distance, {cut.count, options.vertices > 0, options.growth});
    else
        std::fill_n(kept.begin(), cut.count, 1);
    DerivedMesh derived = derived_mesh(h, layer.mesh.faces, kept);
    derived.name = region ? "level with region" : (whole ? "level " : "below level ") + std::to_string(cut.level);
    result.report.add("level", static_cast<int>(cut.level));
    result.report.add("vertices", static_cast<int>(derived.source_vertex.size()));
    result.report.add("faces", static_cast<int>(derived.faces.size()));
    result.report.add("wavelength",
                      whole ? pyramid->levels()[cut.level].wavelength : wavelength_of(derived, layer.mesh.positions),
                      "mesh units");
    if (options.smoothed)
        derived.positions = positions_of(pyramid->scheme().synthesise(pyramid->coefficients(), down_to(cut.level)));
    result.layer = std::move(derived);
    return result;
}

}  // namespace multires
