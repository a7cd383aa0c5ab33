#include "pyramid/wavelengths.h"

#include "base/reduce.h"
#include "hierarchy/parts.h"
#include "measure/measure.h"
#include "mesh/adjacency.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// The parts that the base is in.
class BaseParts {
public:
    explicit BaseParts(const Rings& base) : base_(base), part_(parts_of(base)) {}

    /// Mean length of the edges in the parts that vertices of the last level went to.
    double mean_edge(const Hierarchy& h) {
        std::vector<std::uint8_t> taken(base_.rows(), 0);
        const Level& last = h.levels.back();
        for (Index p = last.coarse; p < last.fine; ++p) {
            Index to = h.parent[p];
            while (to >= last.coarse) to = h.parent[to];
            taken[part_[to]] = 1;
        }
        Mean mean;
        for (Index i = 0; i < base_.rows(); ++i) {
            if (!taken[part_[i]]) continue;
            for (Index e = base_.offset[i]; e < base_.offset[i + 1]; ++e)
                mean.add((h.positions[base_.neighbor[e]] - h.positions[i]).norm());
        }
        return mean.value();
    }

private:
    const Rings& base_;
    Array<Index> part_;  ///< see parts_of()
};

/// Mean length of the edges at the vertices taken between two levels, when they are taken.
double mean_edge_of_taken(const Hierarchy& h, std::size_t fine, std::size_t coarse) {
    const Index first = h.size[coarse] - h.odd.first;
    const auto rows = static_cast<std::size_t>(h.size[fine] - h.size[coarse]);
    return chunked_fold<Mean>(rows,
                              [&](Mean& mean, std::size_t at) {
                                  const Index r = first + static_cast<Index>(at);
                                  const Vec3& p = h.positions[h.odd.vertex(r)];
                                  for (Index e = h.odd.offset[r]; e < h.odd.offset[r + 1]; ++e)
                                      mean.add((h.positions[h.odd.neighbor[e]] - p).norm());
                              })
        .value();
}

/// Of the vertices taken from a level on: a tenth of the level's, if there is one for each.
double mean_edge_of_taken(const Hierarchy& h, std::size_t level) {
    std::size_t coarse = level + 1;
    while (coarse + 1 < h.size.size() && 10 * h.size[coarse] > 9 * h.size[level]) ++coarse;
    return mean_edge_of_taken(h, level, coarse);
}

class EdgesOfLevels {
public:
    EdgesOfLevels(const Hierarchy& h, const Faces& faces, Index base_vertices)
        : h_(h), faces_(faces), parts_(h.base),
          by_taken_(h.lattice.empty() && !h.levels.empty() &&
                    (h.beside > 0 || h.size.back() - h.isolated > base_vertices)) {}

    double mean_edge(std::size_t level) {
        if (by_taken_ && level + 1 < h_.size.size()) return mean_edge_of_taken(h_, level);
        if (by_taken_) return std::max(mean_edge_of_taken(h_, level - 1), parts_.mean_edge(h_));
        if (!h_.mean_edge.empty()) return h_.mean_edge[level];
        return mean_edge_length(level_mesh(h_, faces_, level).faces, h_.positions);
    }

private:
    const Hierarchy& h_;
    const Faces& faces_;
    BaseParts parts_;
    bool by_taken_;
};

}  // namespace

std::vector<double> wavelengths(const Hierarchy& h, const Faces& faces, Index base_vertices) {
    const std::size_t levels = h.levels.size() + 1;
    std::vector<double> out(levels, 0);
    EdgesOfLevels edges(h, faces, base_vertices);
    const auto measured = [&](std::size_t k) {
        if (!h.lattice.empty() && k > 0)
            return std::ldexp(out[0], static_cast<int>(k));  // level by level twice as long
        return 2 * edges.mean_edge(k);
    };
    constexpr std::size_t most = 64;
    std::size_t last = 0;
    out[0] = measured(0);
    for (std::size_t k = 1; k < levels; ++k) {
        const double shrunk = std::log(static_cast<double>(h.size[last]) / h.size[k]);
        if (levels > most && k + 1 < levels && shrunk < 0.2) continue;
        out[k] = measured(k);
        for (std::size_t m = last + 1; m < k; ++m) {
            const double t = shrunk > 0 ? std::log(static_cast<double>(h.size[last]) / h.size[m]) / shrunk : 0;
            out[m] = out[last] > 0 ? out[last] * std::pow(out[k] / out[last], t) : 0;
        }
        last = k;
    }
    return out;
}

}  // namespace multires
