#include "filters/grid/level_values.h"

#include "filters/grid/control_mesh.h"
#include "grids/extension.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace multires {
namespace {

/// One step of subdivision beyond the grid: control points around it are extended.
Raster beyond(const Raster& r, const Mask& mask, SplineBasis basis) {
    const Index rows = 2 * r.rows - 1, columns = 2 * r.columns - 1;
    const CoarseBox box = coarse_box(basis, rows, columns);
    return subdivided(extended(r, mask, -box.first), basis, rows, columns);
}

/// What the control points of a level give at the points of another.
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

void append(const ControlMesh& part, DerivedMesh& all) {
    const auto first = static_cast<Index>(all.source_vertex.size());
    all.source_vertex.insert(all.source_vertex.end(), part.source.begin(), part.source.end());
    all.source_face.insert(all.source_face.end(), part.source_face.begin(), part.source_face.end());
    for (const Face& f : part.faces) all.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
}

void append(const ControlMesh& part, const GridSignal& signal, const std::vector<Raster>& rest, Field& all) {
    for (std::size_t v = 0; v < part.place.size(); ++v)
        for (std::size_t c = 0; c < rest.size(); ++c)
            all.values.push_back(signal.affine(c, part.at[v].x(), part.at[v].y()) + rest[c].values[part.place[v]]);
}

/// The layer's own vertices and faces, on the surface of a level.
GridLevelMesh own_vertices(const FoundGrids& found, const std::vector<GridPyramid>& pyramids,
                           const std::vector<Field>& fields, const Faces& faces, int level) {
    GridLevelMesh all;
    all.mesh.source_vertex.resize(static_cast<std::size_t>(fields[0].rows()));
    std::iota(all.mesh.source_vertex.begin(), all.mesh.source_vertex.end(), 0);
    all.mesh.faces = faces;
    all.mesh.source_face.resize(faces.size());
    std::iota(all.mesh.source_face.begin(), all.mesh.source_face.end(), 0);
    all.values = fields;
    for (std::size_t g = 0; level > 0 && g < found.grids.size(); ++g)
        for (std::size_t f = 0; f < fields.size(); ++f) {
            const GridSignal signal(found.grids[g], fields[f]);
            const int own = std::min(level, pyramids[g].levels());
            signal.add(signal.change_to(surface_of(pyramids[g], signal, own, 0)), all.values[f]);
        }
    return all;
}

bool same_faces(const Mesh& mesh, std::size_t vertices, const Faces& faces) {
    return mesh.positions.size() == vertices && mesh.faces == faces;
}

}  // namespace

GridLevelMesh level_of(const FoundGrids& found, const std::vector<GridPyramid>& pyramids,
                       const std::vector<Field>& fields, const Faces& faces, int level, int shown) {
    if (shown == 0) return own_vertices(found, pyramids, fields, faces, level);
    GridLevelMesh all;
    for (const Field& f : fields) {
        all.values.emplace_back(0, f.width);
        all.values.back().has_positions = f.has_positions;
    }
    for (std::size_t g = 0; g < pyramids.size(); ++g) {
        const Grid& grid = found.grids[g];
        const int from = std::min(level, pyramids[g].levels()), at = std::min(shown, from);
        const ControlMesh part = at < 0 ? divided_grid(grid, -at, faces) : control_mesh(grid, pyramids[g], at, faces);
        append(part, all.mesh);
        for (std::size_t f = 0; f < fields.size(); ++f) {
            const GridSignal signal(grid, fields[f]);
            append(part, signal, surface_of(pyramids[g], signal, from, at), all.values[f]);
        }
    }
    return all;
}

int matching_level(const FoundGrids& found, const std::vector<GridPyramid>& pyramids, const Mesh& layer,
                   const Mesh& edited, const Progress& progress) {
    if (same_faces(edited, layer.positions.size(), layer.faces)) return 0;
    const int most = pyramids[0].levels();
    for (int level = 1; level <= most; ++level) {
        progress.report(0.1 + 0.5 * level / (most + 1), "Finding the level");
        DerivedMesh mesh;
        for (std::size_t g = 0; g < pyramids.size(); ++g)
            append(control_mesh(found.grids[g], pyramids[g], std::min(level, pyramids[g].levels()), layer.faces), mesh);
        if (same_faces(edited, mesh.source_vertex.size(), mesh.faces)) return level;
    }
    throw InputError("edited: it is no control mesh of the current layer; make one with Grid Level as Layer, with the "
                     "same basis and levels, and move its vertices only");
}

void follow(const FoundGrids& found, const std::vector<GridPyramid>& pyramids, const Faces& faces, int level,
            const Field& way, Field& after) {
    Index first = 0;
    const auto width = static_cast<std::size_t>(way.width);
    for (std::size_t g = 0; g < pyramids.size(); ++g) {
        const Grid& grid = found.grids[g];
        if (level == 0) {  // in the layer's own order
            for (const Index v : grid.vertex)
                for (std::size_t c = 0; v >= 0 && c < width; ++c) after.row(v)[c] += way.row(v)[c];
            continue;
        }
        const GridPyramid& pyramid = pyramids[g];
        const int own = std::min(level, pyramid.levels());
        const ControlMesh mesh = control_mesh(grid, pyramid, own, faces);
        std::vector<Raster> change(width, Raster(pyramid.mask(own).rows, pyramid.mask(own).columns, 0));
        for (const std::size_t place : mesh.place) {
            for (std::size_t c = 0; c < width; ++c) change[c].values[place] = way.row(first)[c];
            ++first;
        }
        for (Raster& r : change) r = pyramid.refine(std::move(r), own, 0);
        for (std::size_t p = 0; p < grid.vertex.size(); ++p)
            for (std::size_t c = 0; grid.vertex[p] >= 0 && c < width; ++c)
                after.row(grid.vertex[p])[c] += change[c].values[p];
    }
}

}  // namespace multires
