#include "filters/layers/levels.h"

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
    const auto share = [&](Index count) {  // of the vertices that faces use
        return static_cast<double>(count - h.isolated) / std::max<Index>(1, h.vertices() - h.isolated);
    };
    Cut best{0, h.size[0]};
    const auto off = [&](Index count) { return std::abs(std::log(std::max(share(count), 1e-9) / 0.25)); };
    const auto consider = [&](std::size_t level, Index count) {
        if (off(count) < off(best.count)) best = {level, count};
    };
    for (std::size_t k = 0; k < h.size.size(); ++k) consider(k, h.size[k]);
    if (whole_levels || (share(best.count) >= 0.2 && share(best.count) <= 1 / 3.0)) return best;
    for (std::size_t k = 0; k < h.levels.size(); ++k)
        for (const Index set : h.levels[k].sets) consider(k, h.levels[k].coarse + set);
    return best;
}

/// Of a mesh over places.
double wavelength_of(const Faces& faces, const Hierarchy& h, const Positions& input) {
    Positions at(input.size());
    for (Index p = 0; p < h.vertices(); ++p) at[p] = input[h.order[p]];
    return 2 * mean_edge_length(faces, at);
}

}  // namespace

Result compute_pyramid(const Layer& layer, const ComputePyramidOptions& options, Session& session) {
    Result result;
    const auto pyramid = pyramid_of(layer, options.pyramid, session, result.report);
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
    result.report.add("reconstruction_error", pyramid->reconstruction_error(layer.mesh.positions), "mesh units");
    report_counts(count_input(layer.mesh, pyramid->hierarchy().irregular), result.report);
    return result;
}

Result generate_level(const Layer& layer, const GenerateLevelOptions& options, Session& session) {
    Result result;
    const auto pyramid = pyramid_of(layer, options.pyramid, session, result.report);
    const Hierarchy& h = pyramid->hierarchy();
    const Cut cut = options.level ? given_level(h, *options.level) : automatic_level(h, options.smoothed);
    const bool whole = cut.count == h.size[cut.level];
    LevelMesh mesh = prefix_mesh(h, layer.mesh.faces, cut.count);
    const double wavelength =
        whole ? pyramid->levels()[cut.level].wavelength : wavelength_of(mesh.faces, h, layer.mesh.positions);
    DerivedMesh derived;
    derived.name = (whole ? "level " : "below level ") + std::to_string(cut.level);
    derived.source_vertex.assign(h.order.begin(), h.order.begin() + cut.count);
    derived.faces = std::move(mesh.faces);
    derived.source_face = std::move(mesh.source_face);
    if (options.smoothed)
        derived.positions = positions_of(pyramid->scheme().synthesise(pyramid->coefficients(), down_to(cut.level)));
    result.report.add("level", static_cast<int>(cut.level));
    result.report.add("vertices", static_cast<int>(cut.count));
    result.report.add("faces", static_cast<int>(derived.faces.size()));
    result.report.add("wavelength", wavelength, "mesh units");
    result.layer = std::move(derived);
    return result;
}

}  // namespace multires
