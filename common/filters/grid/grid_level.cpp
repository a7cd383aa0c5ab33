#include "filters/grid/grid_level.h"

#include "filters/grid/control_mesh.h"
#include "filters/placement.h"
#include "grids/extension.h"
#include "mesh/validation.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace multires {
namespace {

/// A control mesh or a refined surface with positions.
struct Part {
    ControlMesh mesh;
    Positions positions;
};

/// One step of subdivision beyond the grid: control points around it are extended.
Raster beyond(const Raster& r, const Mask& mask, SplineBasis basis) {
    const Index rows = 2 * r.rows - 1, columns = 2 * r.columns - 1;
    const CoarseBox box = coarse_box(basis, rows, columns);
    return subdivided(extended(r, mask, -box.first), basis, rows, columns);
}

/// What the control points of a level give, all three coordinates.
/// @param shown  the level of the points, <= level; below 0 finer than the grid
std::vector<Raster> surface_of(const GridPyramid& pyramid, const GridSignal& signal, int level, int shown) {
    std::vector<Raster> all = signal.channels();
    for (Raster& r : all) {
        r = pyramid.refine(pyramid.synthesise(pyramid.analyse(r), level), level, std::max(shown, 0));
        Mask mask = pyramid.mask(0);
        for (int k = 0; k > shown; --k) {
            r = beyond(r, mask, pyramid.basis());
            mask = Mask(r.rows, r.columns, 1);
        }
    }
    return all;
}

/// Of all grids.
std::vector<GridPyramid> pyramids_of(const FoundGrids& found, const GridOptions& options) {
    std::vector<GridPyramid> pyramids;
    for (const Grid& grid : found.grids) pyramids.push_back(pyramid_of(grid, options));
    return pyramids;
}

Part part_of(const Grid& grid, const GridPyramid& pyramid, const Layer& layer, int level, int shown) {
    level = std::min(level, pyramid.levels());
    shown = std::min(shown, level);
    const GridSignal signal(grid, layer.mesh.positions, GridChannels::positions);
    Part part;
    part.mesh =
        shown < 0 ? divided_grid(grid, -shown, layer.mesh.faces) : control_mesh(grid, pyramid, shown, layer.mesh.faces);
    for (const Vec3& p : part.mesh.at) part.positions.push_back(signal.affine(p.x(), p.y()));
    const std::vector<Raster> rest = surface_of(pyramid, signal, level, shown);
    for (std::size_t v = 0; v < part.positions.size(); ++v)
        for (int c = 0; c < 3; ++c) part.positions[v][c] += rest[c].values[part.mesh.place[v]];
    return part;
}

/// The layer's own vertices and faces, on the surface of a level.
DerivedMesh own_vertices(const FoundGrids& found, const std::vector<GridPyramid>& pyramids, const Layer& layer,
                         int level) {
    DerivedMesh all;
    all.source_vertex.resize(layer.mesh.positions.size());
    std::iota(all.source_vertex.begin(), all.source_vertex.end(), 0);
    all.faces = layer.mesh.faces;
    all.source_face.resize(all.faces.size());
    std::iota(all.source_face.begin(), all.source_face.end(), 0);
    all.positions = layer.mesh.positions;
    for (std::size_t g = 0; level > 0 && g < found.grids.size(); ++g) {
        const GridSignal signal(found.grids[g], layer.mesh.positions, GridChannels::positions);
        const int own = std::min(level, pyramids[g].levels());
        signal.add(signal.change_to(surface_of(pyramids[g], signal, own, 0)), *all.positions);
    }
    return all;
}

DerivedMesh joined(const std::vector<Part>& parts) {
    DerivedMesh all;
    all.positions.emplace();
    for (const Part& part : parts) {
        const auto first = static_cast<Index>(all.source_vertex.size());
        all.source_vertex.insert(all.source_vertex.end(), part.mesh.source.begin(), part.mesh.source.end());
        all.source_face.insert(all.source_face.end(), part.mesh.source_face.begin(), part.mesh.source_face.end());
        all.positions->insert(all.positions->end(), part.positions.begin(), part.positions.end());
        for (const Face& f : part.mesh.faces) all.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
    }
    return all;
}

DerivedMesh level_of(const FoundGrids& found, const std::vector<GridPyramid>& pyramids, const Layer& layer, int level,
                     int shown) {
    if (shown == 0) return own_vertices(found, pyramids, layer, level);
    std::vector<Part> parts;
    for (std::size_t g = 0; g < pyramids.size(); ++g)
        parts.push_back(part_of(found.grids[g], pyramids[g], layer, level, shown));
    return joined(parts);
}

bool same_faces(const Mesh& mesh, std::size_t vertices, const Faces& faces) {
    return mesh.positions.size() == vertices && mesh.faces == faces;
}

/// The level whose control mesh has these faces.
DerivedMesh matching_level(const FoundGrids& found, const std::vector<GridPyramid>& pyramids, const Layer& layer,
                           const Layer& edited, const Progress& progress, int& level) {
    const int most = pyramids[0].levels();
    if (same_faces(edited.mesh, layer.mesh.positions.size(), layer.mesh.faces))
        return own_vertices(found, pyramids, layer, level = 0);
    for (level = 1; level <= most; ++level) {
        progress.report(0.1 + 0.5 * level / (most + 1), "Finding the level");
        std::vector<Part> meshes;
        for (std::size_t g = 0; g < pyramids.size(); ++g) {
            const int own = std::min(level, pyramids[g].levels());
            meshes.push_back({control_mesh(found.grids[g], pyramids[g], own, layer.mesh.faces), {}});
        }
        const DerivedMesh mesh = joined(meshes);
        if (same_faces(edited.mesh, mesh.source_vertex.size(), mesh.faces))
            return level_of(found, pyramids, layer, level, level);
    }
    throw InputError("edited: it is no control mesh of the current layer; make one with Grid Level as Layer, with the "
                     "same basis and levels, and move its vertices only");
}

/// What the edit moved each control point by; nothing if single precision cannot tell any of them.
Positions ways_of(const Positions& before, const Positions& after) {
    Positions way(before.size(), Vec3::Zero());
    const auto same = [](const Vec3& a, const Vec3& b) { return a.cast<float>() == b.cast<float>(); };
    if (!std::equal(before.begin(), before.end(), after.begin(), same))
        for (std::size_t v = 0; v < way.size(); ++v) way[v] = after[v] - before[v];
    return way;
}

/// Adds the control points' ways, each times its function.
void follow(const FoundGrids& found, const std::vector<GridPyramid>& pyramids, const Faces& faces, int level,
            const Positions& way, Positions& after) {
    std::size_t first = 0;
    for (std::size_t g = 0; g < pyramids.size(); ++g) {
        const Grid& grid = found.grids[g];
        if (level == 0) {  // in the layer's own order
            for (const Index v : grid.vertex)
                if (v >= 0) after[v] += way[v];
            continue;
        }
        const GridPyramid& pyramid = pyramids[g];
        const int own = std::min(level, pyramid.levels());
        const ControlMesh mesh = control_mesh(grid, pyramid, own, faces);
        std::vector<Raster> change(3, Raster(pyramid.mask(own).rows, pyramid.mask(own).columns, 0));
        for (std::size_t v = 0; v < mesh.place.size(); ++v)
            for (int c = 0; c < 3; ++c) change[c].values[mesh.place[v]] = way[first + v][c];
        first += mesh.place.size();
        for (Raster& r : change) r = pyramid.refine(std::move(r), own, 0);
        for (std::size_t p = 0; p < grid.vertex.size(); ++p)
            if (grid.vertex[p] >= 0)
                for (int c = 0; c < 3; ++c) after[grid.vertex[p]][c] += change[c].values[p];
    }
}

}  // namespace

Result generate_grid_level(const Layer& layer, const GridLevelOptions& options, Session& session) {
    session.progress.report(0, "Finding the grid");
    const FoundGrids found = grids_of(layer, options.grid);
    const std::vector<GridPyramid> pyramids = pyramids_of(found, options.grid);
    const int last = pyramids[0].levels();
    require(options.level >= 0 && options.level <= last,
            "level must be between 0 and " + std::to_string(last) + ", the number of levels of this mesh");
    require(options.refine >= 0 && options.refine <= options.level + 3,
            "refine must be between 0 and " + std::to_string(options.level + 3) + ", three more than the level");
    session.progress.report(0.2, "Transforming");
    DerivedMesh derived = level_of(found, pyramids, layer, options.level, options.level - options.refine);
    derived.name = options.refine == 0 ? "control mesh " + std::to_string(options.level)
                                       : "surface of level " + std::to_string(options.level);
    Result result;
    result.report.add("vertices", static_cast<int>(derived.source_vertex.size()));
    result.report.add("faces", static_cast<int>(derived.faces.size()));
    result.layer = std::move(derived);
    return result;
}

Result grid_edit(const Inputs& inputs, const GridEditOptions& options, Session& session) {
    const Layer& layer = inputs.current;
    Result result;
    session.progress.report(0, "Finding the grid");
    const FoundGrids found = grids_of(layer, options.grid);
    const Layer& edited = inputs.other(options.edited, "edited");
    const std::vector<double> weights = region_weights(layer, options.region);
    require(std::all_of(edited.mesh.positions.begin(), edited.mesh.positions.end(),
                        [](const Vec3& p) { return p.allFinite(); }),
            "edited: coordinates are not numbers or infinite");
    int level = 0;
    const std::vector<GridPyramid> pyramids = pyramids_of(found, options.grid);
    const DerivedMesh before = matching_level(found, pyramids, layer, edited, session.progress, level);
    const Positions way = ways_of(*before.positions, in_layer(edited, layer, "edited"));
    session.progress.report(0.8, "Following");
    Positions after = layer.mesh.positions;
    follow(found, pyramids, layer.mesh.faces, level, way, after);
    blend(layer.mesh.positions, weights, after);
    result.report.add("level", level);
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    return result;
}

}  // namespace multires
