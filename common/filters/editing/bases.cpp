#include "filters/editing/bases.h"

#include "pyramid/pyramid.h"
#include "solvers/system.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace multires {
namespace {

/// Gains that leave out what is finer than the first level with no more than so many vertices: a first guess.
std::vector<double> coarse_gains(const Hierarchy& h, Index vertices) {
    std::vector<double> gains(h.levels.size(), 1);
    for (std::size_t k = 0; k < gains.size() && h.size[k] > vertices; ++k) gains[k] = 0;
    return gains;
}

/// A quantity of each level that grows towards the coarsest, made one of the number of vertices: straight lines
/// between the levels over the logarithm of their numbers of vertices.
class OverVertices {
public:
    OverVertices(const Hierarchy& h, std::vector<double> value) : h_(h), value_(std::move(value)) {}

    double at(Index vertices) const {
        std::size_t k = 0;
        while (k + 2 < h_.size.size() && h_.size[k + 1] > vertices) ++k;
        if (h_.size.size() < 2) return value_[0];
        const double from = log_size(k), to = log_size(k + 1);
        const double t = from > to ? (from - std::log(static_cast<double>(vertices))) / (from - to) : 0;
        return value_[k] + t * (value_[k + 1] - value_[k]);
    }

    /// The number of vertices with a value.
    Index vertices(double value) const {
        Index low = h_.size.back(), high = h_.size.front();
        while (low < high) {
            const Index middle = low + (high - low) / 2;
            if (at(middle) > value) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        return low;
    }

private:
    double log_size(std::size_t k) const { return std::log(static_cast<double>(h_.size[k])); }

    const Hierarchy& h_;
    std::vector<double> value_;
};

OverVertices quantity_of(const Pyramid& pyramid, BandLevels levels) {
    const Hierarchy& h = pyramid.hierarchy();
    std::vector<double> value(h.size.size());
    double sum = 0;
    for (std::size_t k = 0; k < value.size(); ++k) {
        const LevelInfo& level = pyramid.levels()[k];
        if (levels == BandLevels::ratio) value[k] = -std::log(static_cast<double>(h.size[k]));
        if (levels == BandLevels::edge_length) value[k] = std::log(std::max(level.wavelength, 1e-300));
        if (levels == BandLevels::equal_detail) value[k] = sum, sum += level.rms_detail;
    }
    for (std::size_t k = 1; k < value.size(); ++k) value[k] = std::max(value[k], value[k - 1]);
    return {h, std::move(value)};
}

}  // namespace

Base base_through(const Mesh& mesh, const Pyramid& pyramid, Index kept, double tolerance, int most_steps,
                  const Progress& progress) {
    const Hierarchy& h = pyramid.hierarchy();
    SystemOptions how;
    how.bending = true;
    // Squared twice over, the weights of thinner slivers would drown all others in rounding.
    how.stiffness.least_area = 1e-2;
    how.fixed.assign(mesh.positions.size(), 0);
    for (Index p = 0; p < kept; ++p) how.fixed[h.order[p]] = 1;
    Base base{pyramid.synthesise(coarse_gains(h, kept)), 0};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        if (how.fixed[v]) base.positions[v] = mesh.positions[v];
    const System solver(mesh, how, progress.part(0, 0.3));
    SolveOptions solve;
    solve.tolerance = tolerance;
    solve.most_steps = most_steps;
    const Positions nothing(mesh.positions.size(), Vec3::Zero());
    base.steps = solver.solve(0, 1, nothing, base.positions, solve, progress.part(0.3, 1)).steps;
    return base;
}

std::vector<Index> kept_by_bases(const Pyramid& pyramid, BandLevels levels, int count, Index coarsest) {
    const OverVertices quantity = quantity_of(pyramid, levels);
    const double from = quantity.at(pyramid.hierarchy().vertices()), to = quantity.at(coarsest);
    std::vector<Index> kept(count, coarsest);
    for (int j = 0; j + 1 < count; ++j)
        kept[j] = std::max(coarsest, quantity.vertices(from + (to - from) * (j + 1) / count));
    return kept;
}

Multiband multiband_of(const Mesh& mesh, const Pyramid& pyramid, const std::vector<Index>& kept,
                       const Positions* coarsest, const Progress& progress) {
    constexpr double tolerance = 1e-3;
    constexpr int most_steps = 100;
    std::vector<Positions> bases;
    const auto count = static_cast<double>(kept.size());
    for (std::size_t k = 0; k < kept.size(); ++k) {
        const double begin = 0.8 * static_cast<double>(k) / count;
        const Progress now = progress.part(begin, begin + 0.8 / count);
        const bool given = coarsest && k + 1 == kept.size();
        bases.push_back(given ? *coarsest : base_through(mesh, pyramid, kept[k], tolerance, most_steps, now).positions);
    }
    return {mesh, std::move(bases), progress.part(0.8, 1)};
}

}  // namespace multires
