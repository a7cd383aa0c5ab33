#include "editing/wrap.h"

#include "base/blocks.h"
#include "base/reduce.h"
#include "measure/distance.h"
#include "measure/measure.h"
#include "solvers/system.h"

#include <cmath>

namespace multires {
namespace {

/// From where vertices are to the nearest points of the surface.
/// @param face  #V, a face near each, or -1; then the face each is nearest to
Positions ways_to(const SurfaceTree& tree, const Positions& at, Array<Index>& face, const Progress& progress) {
    const auto count = static_cast<Index>(at.size());
    Positions way(at.size());
    parallel_blocks(count, progress, "Wrapping a level onto the edited layer", [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i) {
            const SurfaceTree::Hit hit = tree.closest(at[i], face[i]);
            way[i] = hit.point - at[i], face[i] = hit.face;
        }
    });
    return way;
}

}  // namespace

Wrapped wrap(const Mesh& mesh, const Faces& faces, const Positions& surface, const Progress& progress) {
    constexpr int steps = 16;
    progress.report(0, "Setting up the equations");
    const SurfaceTree tree(faces, surface);
    const System solver(mesh, {}, progress.part(0, 0.1));
    const Stiffness& c = solver.matrices();
    const double longest = bounding_box(mesh.positions).diagonal() / 4;
    const double shortest = mean_edge_length(mesh.faces, mesh.positions);
    Wrapped out{mesh.positions, 0};
    Positions u(mesh.positions.size(), Vec3::Zero()), wanted;
    Array<Index> face(mesh.positions.size(), -1);
    for (int step = 0; step < steps; ++step) {
        const Progress now = progress.part(0.1 + 0.9 * step / steps, 0.1 + 0.9 * (step + 1) / steps);
        wanted = ways_to(tree, out.positions, face, now.part(0, 0.5));
        const double length = longest * std::pow(shortest / longest, static_cast<double>(step) / (steps - 1));
        for (std::size_t i = 0; i < u.size(); ++i) wanted[i] = c.mass[i] * (wanted[i] + u[i]);
        SolveOptions how;
        how.tolerance = 1e-6;
        solver.solve(1, length * length, wanted, u, how, now.part(0.5, 1));
        for (std::size_t i = 0; i < u.size(); ++i) out.positions[i] = mesh.positions[i] + u[i];
    }
    const Positions left = ways_to(tree, out.positions, face, progress.part(0.99, 1));
    out.distance = chunked_fold<Lengths>(left.size(), [&](Lengths& part, std::size_t i) {
                       part.add(left[i].squaredNorm(), c.mass[i]);
                   }).rms();
    return out;
}

}  // namespace multires
