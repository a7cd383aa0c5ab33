#include "pyramid/pyramid.h"

#include "base/free_memory.h"
#include "base/parallel.h"
#include "base/reduce.h"
#include "mesh/adjacency.h"
#include "pyramid/wavelengths.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace multires {
namespace {

/// The options, with what the scheme and the table of levels need of a hierarchy.
HierarchyOptions hierarchy_options(const PyramidOptions& o) {
    HierarchyOptions h = o.hierarchy;
    h.flaps = uses_flaps(o.scheme.op);
    h.even_rings = schemes().at(static_cast<std::size_t>(o.scheme.row)).capabilities.even_rings;
    h.mean_edges = true;
    return h;
}

/// Of a scheme's own kind, or of collapses.
Hierarchy hierarchy_of(const Layer& layer, const PyramidOptions& options, const Progress& progress) {
    const SchemeRow& row = schemes().at(static_cast<std::size_t>(options.scheme.row));
    if (row.own_hierarchy) {
        require(options.features.from == Features::none,
                "features: the scheme " + row.name + " smooths across edges; choose none, or another scheme");
        progress.report(0.3, "Finding the grid");
        return row.own_hierarchy(layer.mesh, hierarchy_options(options));
    }
    progress.report(0, "Finding the neighbours");
    Rings rings = surface_rings(layer.mesh);
    mark_features(rings, layer, options.features.from, options.features.angle);
    const Progress building = progress.part(0.05, 0.6);
    return build_hierarchy(std::move(rings), layer.mesh.positions, hierarchy_options(options),
                           [&](double f) { building.report(f, "Building the pyramid"); });
}

constexpr std::size_t much = 4 << 20;  // bytes: less is not worth the time to get it back

/// to_places(..., field_of(positions)) without the field between.
Field in_places(const Hierarchy& h, const Positions& positions) {
    Field f = Field::unset(h.vertices(), 3);
    parallel_for(f.rows(), [&](Index p) { std::copy_n(positions[h.order[p]].data(), 3, f.row(p)); });
    return f;
}

template <class Values>
double sum_of_squares(const Values& values) {
    return chunked_reduce<double>(values.size(), [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += static_cast<double>(values[i]) * values[i];
        return sum;
    });
}

double rms_length(const std::vector<Subband>& subbands) {
    double sum = 0;
    std::size_t values = 0;
    for (const Subband& band : subbands) {
        sum += sum_of_squares(band.values.values) + sum_of_squares(band.single);
        values += band.values.values.size() + band.single.size();
    }
    return values ? std::sqrt(sum / (static_cast<double>(values) / 3)) : 0;
}

std::vector<LevelInfo> describe(const Hierarchy& h, const Coefficients& c, const std::vector<double>& wavelength) {
    std::vector<LevelInfo> info(wavelength.size());
    for (std::size_t k = 0; k < info.size(); ++k) {
        info[k].vertices = h.size[k] - h.isolated;
        info[k].wavelength = wavelength[k];
        if (k < c.level.size()) info[k].rms_detail = rms_length(c.level[k]);
    }
    return info;
}

}  // namespace

Pyramid::Pyramid(const Layer& layer, const PyramidOptions& options, const Progress& progress,
                 const std::function<void()>& layer_read)
    : hash_(content_hash(layer, options)), shape_(shape_hash(layer.mesh.positions, layer.mesh.faces)),
      hierarchy_(hierarchy_of(layer, options, progress)) {
    const std::vector<double> wavelength = wavelengths(hierarchy_, layer.mesh.faces, options.hierarchy.base_vertices);
    return_free_memory(much);  // the holes that the hierarchy left
    progress.report(0.6, "Computing weights");
    scheme_ = make_scheme(hierarchy_, options.scheme);
    progress.report(0.8, "Computing details");
    hierarchy_.positions = Positions();  // the layer has them
    Field f = in_places(hierarchy_, layer.mesh.positions);
    if (layer_read) layer_read();
    return_free_memory(much);  // and those of positions and layer
    coefficients_ = scheme_->analyse(std::move(f), options.scheme.storage);
    levels_ = describe(hierarchy_, coefficients_, wavelength);
    bytes_ = sizeof(Pyramid) + multires::bytes(hierarchy_) + scheme_->bytes() + multires::bytes(coefficients_) +
             levels_.capacity() * sizeof(LevelInfo);
    return_free_memory(much);  // those that details left
    progress.report(1, "Pyramid built");
}

double Pyramid::reconstruction_error(const std::function<Vec3(Index)>& position) const {
    std::atomic<double> largest{0};  // square
    scheme_->hand_over(coefficients_, [&](Index place, const double* back) {
        const double square = (position(hierarchy_.order[place]) - Eigen::Map<const Vec3>(back)).squaredNorm();
        double before = largest.load(std::memory_order_relaxed);
        while (square > before && !largest.compare_exchange_weak(before, square, std::memory_order_relaxed)) continue;
    });
    return std::sqrt(largest);
}

Positions Pyramid::synthesise(std::vector<double> gain) const {
    return positions_in_input(hierarchy_, scheme_->synthesise(coefficients_, with_gain(std::move(gain))));
}

}  // namespace multires
