#include "pyramid/pyramid.h"

#include "base/parallel.h"
#include "base/reduce.h"
#include "measure/measure.h"
#include "mesh/adjacency.h"
#include "mesh/validation.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

HierarchyOptions hierarchy_options(const PyramidOptions& o) {
    HierarchyOptions h;
    h.grouping = o.grouping;
    h.sets_per_level = o.sets_per_level;
    h.level_ratio = o.level_ratio;
    h.base_vertices = o.base_vertices;
    h.length_weight = o.length_weight;
    h.normal_limit_degrees = o.normal_limit;
    h.seed = o.seed;
    h.flaps = uses_flaps(o.op);
    h.mean_edges = true;
    return h;
}

RelaxationTransformOptions transform_options(const PyramidOptions& o) {
    RelaxationTransformOptions t;
    t.scheme = o.scheme;
    t.relaxation.op = o.op;
    t.presmooth = o.presmooth;
    t.weights = o.storage;
    return t;
}

/// Twice the mean edge length of every level.
std::vector<double> wavelengths(const Hierarchy& h, const Faces& faces) {
    const std::size_t levels = h.levels.size() + 1;
    std::vector<double> out(levels, 0);
    const auto exact = [&](std::size_t k) {
        return 2 *
               (h.mean_edge.empty() ? mean_edge_length(level_mesh(h, faces, k).faces, h.positions) : h.mean_edge[k]);
    };
    // With thousands of levels, a few are measured and those between follow, in the logarithm.
    constexpr std::size_t most = 64;
    std::size_t last = 0;
    out[0] = exact(0);
    for (std::size_t k = 1; k < levels; ++k) {
        const double shrunk = std::log(static_cast<double>(h.size[last]) / h.size[k]);
        if (levels > most && k + 1 < levels && shrunk < 0.2) continue;
        out[k] = exact(k);
        for (std::size_t m = last + 1; m < k; ++m) {
            const double t = shrunk > 0 ? std::log(static_cast<double>(h.size[last]) / h.size[m]) / shrunk : 0;
            out[m] = out[last] > 0 ? out[last] * std::pow(out[k] / out[last], t) : 0;
        }
        last = k;
    }
    return out;
}

template <class Values>
double sum_of_squares(const Values& values) {
    return chunked_reduce<double>(values.size(), [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += static_cast<double>(values[i]) * values[i];
        return sum;
    });
}

double rms_length(const Coefficients::Detail& d) {
    const double sum = sum_of_squares(d.odd.values) + sum_of_squares(d.even.values) + sum_of_squares(d.odd_single) +
                       sum_of_squares(d.even_single);
    const std::size_t values = d.odd.values.size() + d.even.values.size() + d.odd_single.size() + d.even_single.size();
    return values ? std::sqrt(sum / (static_cast<double>(values) / 3)) : 0;
}

std::vector<LevelInfo> describe(const Hierarchy& h, const Coefficients& c, const std::vector<double>& wavelength) {
    std::vector<LevelInfo> info(wavelength.size());
    for (std::size_t k = 0; k < info.size(); ++k) {
        info[k].vertices = h.size[k] - h.isolated;
        info[k].wavelength = wavelength[k];
        if (k < c.detail.size()) info[k].rms_detail = rms_length(c.detail[k]);
    }
    return info;
}

}  // namespace

void check(const PyramidOptions& o) {
    require(o.presmooth >= 0 && o.presmooth <= 1, "presmooth must be between 0 and 1");
    require(o.sets_per_level >= 1, "sets_per_level must be at least 1");
    require(o.level_ratio >= 0 && o.level_ratio < 1, "level_ratio must be at least 0 and less than 1");
    require(o.base_vertices >= 4, "base_vertices must be at least 4");
    require(o.length_weight >= 0 && std::isfinite(o.length_weight), "length_weight must be a number, 0 or more");
    require(o.normal_limit > 0 && o.normal_limit <= 180, "normal_limit must be more than 0 and at most 180 degrees");
}

void mark_features(Rings& rings, const Layer& layer, Features features, double angle) {
    const auto edges = [&](const std::vector<std::uint8_t>& bits, std::uint8_t flip, const char* what) {
        require(!bits.empty(), std::string("features: the mesh has no ") + what + " edges");
        std::vector<std::uint8_t> marked = bits;
        for (std::uint8_t& b : marked) b ^= flip;
        mark_features(rings, layer.mesh.faces, marked);
    };
    switch (features) {
    case Features::none:
        return;
    case Features::angle:
        require(angle > 0 && angle < 180, "feature_angle must be between 0 and 180 degrees");
        return mark_features_by_angle(rings, layer.mesh.positions, angle);
    case Features::non_faux_edges:
        return edges(layer.faux_edges, 7, "faux");
    case Features::selected_edges:
        return edges(layer.selected_edges, 0, "selected");
    }
}

ContentHash content_hash(const Layer& layer, const PyramidOptions& o) {
    const double options[] = {static_cast<double>(o.scheme),
                              static_cast<double>(o.op),
                              o.presmooth,
                              static_cast<double>(o.grouping),
                              static_cast<double>(o.sets_per_level),
                              o.level_ratio,
                              static_cast<double>(o.base_vertices),
                              o.length_weight,
                              o.normal_limit,
                              static_cast<double>(o.storage),
                              static_cast<double>(o.features),
                              o.features == Features::angle ? o.feature_angle : 0,
                              static_cast<double>(o.seed)};
    const ContentHash shape = shape_hash(layer.mesh.positions, layer.mesh.faces);
    XXH3_state_t state;
    XXH3_128bits_reset(&state);
    const auto add = [&](const void* data, std::size_t bytes) {
        if (bytes) XXH3_128bits_update(&state, data, bytes);
    };
    add(options, sizeof options);
    add(shape.data(), sizeof shape);
    if (o.features == Features::non_faux_edges) add(layer.faux_edges.data(), layer.faux_edges.size());
    if (o.features == Features::selected_edges) add(layer.selected_edges.data(), layer.selected_edges.size());
    const XXH128_hash_t hash = XXH3_128bits_digest(&state);
    return {hash.low64, hash.high64};
}

KeptPyramid::KeptPyramid(const Layer& layer, const PyramidOptions& options, const Progress& progress)
    : hash_(content_hash(layer, options)) {
    const BlockReuse reuse;
    const Progress building = progress.part(0.05, 0.6);
    progress.report(0, "Finding the neighbours");
    Rings rings = vertex_rings(layer.mesh);
    mark_features(rings, layer, options.features, options.feature_angle);
    hierarchy_ = build_hierarchy(std::move(rings), layer.mesh.positions, hierarchy_options(options),
                                 [&](double f) { building.report(f, "Building the pyramid"); });
    progress.report(0.6, "Computing weights");
    transform_ = relaxation_transform(hierarchy_, transform_options(options));
    progress.report(0.8, "Computing details");
    Field f = field_of(hierarchy_.positions);
    const std::vector<double> wavelength = wavelengths(hierarchy_, layer.mesh.faces);
    hierarchy_.positions = Positions();  // the layer has them
    coefficients_ = transform_->analyse(std::move(f), options.storage);
    levels_ = describe(hierarchy_, coefficients_, wavelength);
    progress.report(1, "Pyramid built");
}

double KeptPyramid::reconstruction_error(const Positions& positions) const {
    struct Largest {
        double square = 0;
        Largest& operator+=(const Largest& o) {
            square = std::max(square, o.square);
            return *this;
        }
    };
    const Field back = transform_->synthesise(coefficients_);
    const auto largest = chunked_reduce<Largest>(back.rows(), [&](std::size_t begin, std::size_t end) {
        Largest part;
        for (std::size_t p = begin; p < end; ++p)
            part += {(positions[hierarchy_.order[p]] - Vec3(back.row(static_cast<Index>(p)))).squaredNorm()};
        return part;
    });
    return std::sqrt(largest.square);
}

Positions KeptPyramid::synthesise(const std::vector<double>& gain) const {
    return positions_in_input(hierarchy_, transform_->synthesise(coefficients_, gain));
}

}  // namespace multires
