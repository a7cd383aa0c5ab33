#include "filters/editing/smooth_base.h"

#include "base/array.h"
#include "measure/measure.h"
#include "mesh/validation.h"
#include "pyramid/pyramid.h"
#include "solvers/system.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace multires {
namespace {

/// Gains that leave out what is finer than the first level with no more than so many vertices: a first guess.
std::vector<double> coarse_gains(const Hierarchy& h, Index vertices) {
    std::vector<double> gains(h.levels.size(), 1);
    for (std::size_t k = 0; k < gains.size() && h.size[k] > vertices; ++k) gains[k] = 0;
    return gains;
}

DerivedMesh same_connectivity(const Mesh& mesh, Positions positions, Index kept) {
    DerivedMesh derived;
    derived.name = "base of " + std::to_string(kept) + " vertices";
    derived.source_vertex.resize(mesh.positions.size());
    std::iota(derived.source_vertex.begin(), derived.source_vertex.end(), 0);
    derived.faces = mesh.faces;
    derived.source_face.resize(mesh.faces.size());
    std::iota(derived.source_face.begin(), derived.source_face.end(), 0);
    derived.positions = std::move(positions);
    return derived;
}

}  // namespace

Result generate_base(const Layer& layer, const SmoothBaseOptions& options, Session& session) {
    require_usable(layer.mesh);
    Result result;
    const Progress whole = session.progress;
    session.progress = whole.part(0, 0.2);
    const auto pyramid = pyramid_of(layer, options.pyramid, session, result.report);
    session.progress = whole;
    const Hierarchy& h = pyramid->hierarchy();
    const Index kept = std::max<Index>(options.vertices, h.size.back());
    require(kept <= h.vertices(),
            "vertices must be at most " + std::to_string(h.vertices()) + ", all that the mesh has");
    SystemOptions how;
    how.bending = true;
    how.fixed.assign(layer.mesh.positions.size(), 0);
    for (Index p = 0; p < kept; ++p) how.fixed[h.order[p]] = 1;
    Positions base = pyramid->synthesise(coarse_gains(h, kept));
    for (std::size_t v = 0; v < base.size(); ++v)
        if (how.fixed[v]) base[v] = layer.mesh.positions[v];
    const System solver(layer.mesh, how, whole.part(0.2, 0.4));
    SolveOptions solve;
    solve.tolerance = 1e-6;
    solve.most_steps = 400;
    const Positions nothing(base.size(), Vec3::Zero());
    const Solved solved = solver.solve(0, 1, nothing, base, solve, whole.part(0.4, 0.95));
    whole.report(0.95, "Making the layer");
    const Displacement way = displacement(layer.mesh.positions, base);
    result.report.add("vertices_kept", static_cast<int>(kept));
    result.report.add("rms_displacement", way.rms, "mesh units");
    result.report.add("largest_displacement", way.largest, "mesh units");
    result.report.add("solver_steps", solved.steps);
    result.layer = same_connectivity(layer.mesh, std::move(base), kept);
    return result;
}

}  // namespace multires
