#include "pyramid/bodies.h"

#include "base/parallel.h"
#include "base/reduce.h"
#include "hierarchy/parts.h"
#include "mesh/specks.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace multires {
namespace {

/// More levels than that (one vertex each) are for thresholding.
constexpr std::size_t most_levels = 64;

class Parts {
public:
    explicit Parts(const Hierarchy& h) : h_(h), base_part_(parts_of(h.base)), size_(h.base.rows(), 0) {}

    bool one() {
        Index found = -1;
        for (Index i = 0; i < h_.base.rows(); ++i) {
            if (h_.base.kind[i] == RingKind::isolated) continue;
            if (found >= 0 && base_part_[i] != found) return false;
            found = base_part_[i];
        }
        return true;
    }

    /// #V: for each place the group of its body, by the density of the finest mesh.
    Array<std::uint8_t> groups(const Mesh& mesh) {
        Array<Index> part(h_.vertices());  // parents come before their children
        std::vector<Index> of_vertex(h_.vertices());
        for (Index p = 0; p < h_.vertices(); ++p) {
            part[p] = p < h_.base.rows() ? base_part_[p] : part[h_.parent[p]];
            of_vertex[h_.order[p]] = part[p];
            ++size_[part[p]];
        }
        std::vector<Mean> edge(h_.base.rows());
        for (const Face& f : mesh.faces)
            for (int k = 0; k < 3; ++k)
                edge[of_vertex[f[0]]].add((mesh.positions[f[k]] - mesh.positions[f[(k + 1) % 3]]).norm());
        const Index largest = static_cast<Index>(std::max_element(size_.begin(), size_.end()) - size_.begin());
        std::vector<int> step(size_.size(), 0);
        std::map<int, std::uint8_t> number{{0, 0}};
        for (Index i = 0; i < h_.base.rows(); ++i)
            if (size_[i] > 0) number[step[i] = step_of(i, largest, edge)] = 0;
        std::uint8_t next = 1;
        for (auto& [s, n] : number)
            if (s != 0) n = next++;
        if (next == 1) return {};
        Array<std::uint8_t> group(h_.vertices());
        for (Index p = 0; p < h_.vertices(); ++p) group[p] = number[step[part[p]]];
        return group;
    }

private:
    int step_of(Index i, Index largest, const std::vector<Mean>& edge) const {
        const double ratio = edge[i].value() / edge[largest].value();
        if (is_speck(size_[i], size_[largest]) || !(ratio > 0 && std::isfinite(ratio))) return 0;
        return static_cast<int>(std::clamp(std::round(2 * std::log2(ratio)), -100.0, 100.0));
    }

    const Hierarchy& h_;
    Array<Index> base_part_;   ///< see parts_of()
    std::vector<Index> size_;  ///< by root
};

/// Wavelengths of the levels of each group. Where a level takes nothing of it, it is as coarse as it was.
std::vector<std::vector<double>> wavelengths(const Hierarchy& h, const Positions& positions,
                                             const Array<std::uint8_t>& group, std::size_t groups) {
    const std::size_t levels = h.levels.size();
    std::vector<std::vector<Mean>> edge(groups, std::vector<Mean>(levels + 1));
    const auto add = [&](std::size_t level, const Rings& rings, Index r) {
        const Index p = rings.vertex(r);
        for (Index e = rings.offset[r]; e < rings.offset[r + 1]; ++e)
            edge[group[p]][level].add((positions[h.order[rings.neighbor[e]]] - positions[h.order[p]]).norm());
    };
    for (std::size_t k = 0; k < levels; ++k)
        for (Index r = h.levels[k].odd.begin; r < h.levels[k].odd.end; ++r) add(k, h.odd, r);
    for (Index i = 0; i < h.base.rows(); ++i) add(levels, h.base, i);
    std::vector<std::vector<double>> out(groups, std::vector<double>(levels + 1, 0));
    for (std::size_t g = 0; g < groups; ++g) {
        const auto first = std::find_if(edge[g].begin(), edge[g].end(), [](const Mean& m) { return m.weight > 0; });
        double longest = first == edge[g].end() ? 0 : 2 * first->value();
        for (std::size_t k = 0; k <= levels; ++k)
            out[g][k] = longest = edge[g][k].weight > 0 ? std::max(longest, 2 * edge[g][k].value()) : longest;
    }
    return out;
}

}  // namespace

bool all_one(const Gains& gains) {
    return std::all_of(gains.begin(), gains.end(), [](const std::vector<double>& group) {
        return std::all_of(group.begin(), group.end(), [](double g) { return g == 1; });
    });
}

Bodies::Bodies(const Pyramid& pyramid, const Layer& layer) : all_(pyramid) {
    const Hierarchy& h = pyramid.hierarchy();
    Parts parts(h);
    if (h.levels.empty() || h.levels.size() > most_levels || !h.lattice.empty() || parts.one()) return;
    group_ = parts.groups(layer.mesh);
    if (group_.empty()) return;
    const std::size_t groups = 1 + *std::max_element(group_.begin(), group_.end());
    for (const std::vector<double>& lengths : wavelengths(h, layer.mesh.positions, group_, groups)) {
        own_.push_back(pyramid.levels());
        for (std::size_t k = 0; k < lengths.size(); ++k) own_.back()[k].wavelength = lengths[k];
    }
}

Field Bodies::synthesise(const Coefficients& coefficients, const Gains& gains) const {
    const Scheme& scheme = all_.scheme();
    Field out = scheme.synthesise(coefficients, with_gain(gains[0]));
    for (std::size_t g = 1; g < gains.size(); ++g) {
        if (gains[g] == gains[0]) continue;
        const Field own = scheme.synthesise(coefficients, with_gain(gains[g]));
        parallel_for(out.rows(), [&](Index p) {
            if (group_[p] == g) std::copy_n(own.row(p), own.width, out.row(p));
        });
    }
    return out;
}

Positions Bodies::synthesise(const Gains& gains) const {
    return positions_in_input(all_.hierarchy(), synthesise(all_.coefficients(), gains));
}

std::vector<double> band_gains(const std::vector<LevelInfo>& levels, const Band& band, double diagonal, double gain) {
    std::vector<double> gains = band_share(levels, band, diagonal);
    for (double& g : gains) g = 1 + g * (gain - 1);
    return gains;
}

Gains band_gains(const Bodies& bodies, const Band& band, double diagonal, double gain) {
    return bodies.gains([&](const auto& levels) { return band_gains(levels, band, diagonal, gain); });
}

Field Bodies::filter(const Field& field, const Gains& gains) const {
    const Coefficients details = all_.scheme().analyse(to_places(all_.hierarchy(), field));
    return to_input(all_.hierarchy(), synthesise(details, gains));
}

}  // namespace multires
