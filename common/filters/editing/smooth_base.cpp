#include "filters/editing/smooth_base.h"

#include "filters/editing/bases.h"
#include "measure/measure.h"
#include "mesh/validation.h"
#include "pyramid/pyramid.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace multires {
namespace {

DerivedMesh layer_of_base(const Mesh& mesh, Positions positions, Index kept) {
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
    Base base = base_through(layer.mesh, *pyramid, kept, 1e-6, 400, whole.part(0.2, 0.95));
    whole.report(0.95, "Making the layer");
    const Displacement way = displacement(layer.mesh.positions, base.positions);
    result.report.add("vertices_kept", static_cast<int>(kept));
    result.report.add("rms_displacement", way.rms, "mesh units");
    result.report.add("largest_displacement", way.largest, "mesh units");
    result.report.add("solver_steps", base.steps);
    result.layer = layer_of_base(layer.mesh, std::move(base.positions), kept);
    return result;
}

}  // namespace multires
