#include "editing/falloff.h"

#include "base/angles.h"
#include "editing/soft_border.h"
#include "solvers/system.h"

#include <algorithm>
#include <cmath>

namespace multires {

std::vector<double> falloff(const Mesh& mesh, const std::vector<std::uint8_t>& inside, double distance,
                            const Progress& progress) {
    progress.report(0, "Measuring the distance");
    const std::vector<double> away = distances_along_edges(mesh, inside, distance);
    SystemOptions how;
    how.fixed.resize(inside.size());
    Array<double> t(inside.size());
    bool between = false;
    for (std::size_t v = 0; v < inside.size(); ++v) {
        const bool free = !inside[v] && away[v] < distance;
        between = between || free;
        how.fixed[v] = !free;
        t[v] = inside[v] ? 1 : free ? 1 - away[v] / distance : 0;
    }
    if (between) {
        const System solver(mesh, how, progress.part(0.2, 0.5));
        const Array<double> nothing(inside.size(), 0.0);
        SolveOptions options;
        options.tolerance = 1e-10;
        solver.solve(0, 1, ConstRows(nothing, 1), Rows(t, 1), options, progress.part(0.5, 1));
    }
    std::vector<double> theta(inside.size());
    for (std::size_t v = 0; v < theta.size(); ++v)
        theta[v] = how.fixed[v] ? t[v] : 0.5 - 0.5 * std::cos(pi * std::clamp(t[v], 0.0, 1.0));
    return theta;
}

}  // namespace multires
