#include "filters/layers/adaptive.h"

#include "filters/layers/adaptive_search.h"
#include "filters/layers/texture_seams.h"
#include "measure/distance.h"
#include "measure/measure.h"
#include "mesh/adjacency.h"
#include "mesh/validation.h"
#include "pyramid/bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace multires {
namespace {

constexpr int attributes = 5;
struct NamedThreshold {
    const char* name;
    DetailThreshold* threshold;
};
std::array<NamedThreshold, attributes> thresholds(AdaptiveOptions& o) {
    return {{{"geometry", &o.geometry},
             {"color", &o.color},
             {"quality", &o.quality},
             {"texcoord", &o.texcoord},
             {"normal", &o.normal}}};
}

/// Checks the options; where thresholds only say how attributes compare, a single one is set to 1.
AdaptiveOptions checked(AdaptiveOptions o) {
    int used = 0;
    for (const auto& [name, t] : thresholds(o)) {
        used += t->use;
        require(!t->use || t->threshold >= 0, std::string(name) + "_threshold must be a number, 0 or more");
    }
    require(used > 0, "use_geometry: at least one kind of detail must be used");
    if (o.target != Target::threshold)
        for (const auto& [name, t] : thresholds(o)) {
            if (used == 1) t->threshold = 1;
            require(!t->use || (t->threshold > 0 && std::isfinite(t->threshold)),
                    std::string(name) + "_threshold must be more than 0 when several kinds of detail share a target");
        }
    require(o.target != Target::faces || o.faces >= 0, "faces must be 0 or more");
    require(o.target != Target::vertices || o.vertices >= 0, "vertices must be 0 or more");
    const bool bound = o.target == Target::rms_distance || o.target == Target::largest_distance;
    require(!bound || (o.error > 0 && std::isfinite(o.error)), "error must be more than 0");
    require(std::isfinite(o.band_gain), "band_gain must be a number");
    require(o.base_vertices >= 4, "base_vertices must be at least 4");
    require(o.normal_limit > 0 && o.normal_limit <= 180, "normal_limit must be more than 0 and at most 180 degrees");
    return o;
}

/// The layer with a band of its details scaled.
Layer filtered(const Layer& layer, const AdaptiveOptions& o, Session& session) {
    Report ignored;
    Layer out = layer;
    const auto pyramid = pyramid_of(layer, o.band_pyramid, session, ignored);
    const Bodies bodies(*pyramid, layer);
    out.mesh.positions = bodies.synthesise(band_gains(bodies, o.band, box_diagonal(layer), o.band_gain));
    return out;
}

/// Makes reconstructions of one layer.
class Reconstructor {
public:
    Reconstructor(const Layer& layer, const AdaptiveOptions& options, const Hierarchy& h, const Insertion& insertion)
        : layer_(layer), options_(options), h_(h), insertion_(insertion), region_(selected_region(layer)) {
        base_faces_ = faces_of(h.size.back());
        const auto faces = std::count_if(layer.mesh.faces.begin(), layer.mesh.faces.end(),
                                         [](const Face& f) { return !repeats_an_index(f); });
        faces_twice_ = std::accumulate(insertion.faces.begin(), insertion.faces.end(), base_faces_) != faces;
    }

    Reconstruction make(Index count, bool measure) const {
        Reconstruction r;
        r.count = count;
        const std::vector<std::uint8_t> in = inserted(insertion_, count);
        const Array<Index> left = places_left(h_, [&](Index place) { return in[place] != 0; });
        LevelMesh mesh = mesh_of_places(h_, layer_.mesh.faces, left);
        std::vector<Index> place_of(h_.vertices()), index_of(h_.vertices());
        for (Index p = 0; p < h_.vertices(); ++p) place_of[h_.order[p]] = p;
        std::vector<std::uint8_t> fixed;
        for (Index v = 0; v < h_.vertices(); ++v) {
            const Index p = place_of[v];
            if (!in[p]) continue;
            index_of[p] = static_cast<Index>(r.mesh.source_vertex.size());
            r.mesh.source_vertex.push_back(v);
            r.positions.push_back(layer_.mesh.positions[v]);
            const bool kept = p >= h_.size.back() ? std::isinf(insertion_.key[p]) : region_[v] != 0;
            fixed.push_back(options_.region_of_interest && kept);
        }
        for (Face& f : mesh.faces) f = {index_of[f[0]], index_of[f[1]], index_of[f[2]]};
        r.mesh.faces = std::move(mesh.faces);
        r.mesh.source_face = std::move(mesh.source_face);
        if (options_.fit && count < h_.vertices()) {
            std::vector<Index> into(h_.vertices());
            for (Index v = 0; v < h_.vertices(); ++v) into[v] = index_of[left[place_of[v]]];
            r.positions = fitted(layer_.mesh, r.mesh.faces, r.positions, into, fixed);
        }
        if (measure)
            r.distance = count == h_.vertices()
                             ? Distance()
                             : two_sided_distance(layer_.mesh.faces, layer_.mesh.positions, r.mesh.faces, r.positions);
        return r;
    }

    /// Faces of the base mesh.
    int base_faces() const { return base_faces_; }

    /// The largest prefix with at most so many faces, and at least `least` vertices.
    Index count_for_faces(Index least, int most) const {
        if (faces_twice_) return searched_for_faces(least, most);
        int faces = base_faces_;
        Index count = h_.size.back();
        while (count < h_.vertices()) {
            faces += insertion_.faces[insertion_.order[count]];
            if (faces > most && count >= least) break;
            ++count;
        }
        return count;
    }

private:
    int faces_of(Index count) const {
        return static_cast<int>(mesh_of_set(h_, layer_.mesh.faces, inserted(insertion_, count)).faces.size());
    }

    /// The same where faces are there twice, so that vertices come with more of them than their rings say.
    Index searched_for_faces(Index least, int most) const {
        Index low = std::max(least, h_.size.back()), high = h_.vertices();
        while (low < high) {
            const Index middle = low + (high - low + 1) / 2;
            if (faces_of(middle) <= most)
                low = middle;
            else
                high = middle - 1;
        }
        return low;
    }

    const Layer& layer_;
    const AdaptiveOptions& options_;
    const Hierarchy& h_;
    const Insertion& insertion_;
    std::vector<std::uint8_t> region_;
    int base_faces_;
    bool faces_twice_;  ///< there are more than vertices bring with them
};

void report_thresholds(AdaptiveOptions o, double scale, Report& report) {
    for (const auto& [name, t] : thresholds(o)) {
        if (!t->use) continue;
        const bool length = t == &o.geometry;
        const std::string unit = !length                         ? ""
                                 : o.unit == LengthUnit::percent ? "percent of the diagonal"
                                                                 : "mesh units";
        report.add(std::string(name) + "_threshold_used", t->threshold * scale, unit);
    }
}

}  // namespace

Rings adaptive_rings(const Layer& layer, const AdaptiveOptions& options) {
    Rings rings = surface_rings(layer.mesh);
    mark_features(rings, layer, options.features, options.feature_angle);
    if (options.texcoord.use && !corner_texcoords(layer).empty())
        mark_features(rings, layer.mesh.faces, texture_seams(layer).edges);
    return rings;
}

HierarchyOptions adaptive_collapses(const AdaptiveOptions& options) {
    HierarchyOptions h;
    h.base_vertices = options.base_vertices;
    h.normal_limit_degrees = options.normal_limit;
    h.length_weight = 0;
    h.set_share = 0.5;
    h.memoryless = true;
    h.boundary_weight = boundary_weight;
    h.flaps = uses_flaps(options.op);
    h.even_rings = false;
    return h;
}

Hierarchy adaptive_hierarchy(const Layer& layer, Rings rings, const AdaptiveOptions& options,
                             const Progress& progress) {
    return build_hierarchy(std::move(rings), layer.mesh.positions, adaptive_collapses(options),
                           [&](double f) { progress.report(f, "Building the hierarchy"); });
}

Result result_of(Reconstruction r, const Layer& layer, bool with_positions, Report report) {
    Result result;
    report.add("faces", static_cast<int>(r.mesh.faces.size()));
    report.add("vertices", static_cast<int>(r.mesh.source_vertex.size()));
    if (r.distance) {
        report.add("rms_distance", r.distance->rms, "mesh units");
        report.add("largest_distance", r.distance->largest, "mesh units");
        report.add("rms_distance_percent", 100 * r.distance->rms / box_diagonal(layer), "percent of the diagonal");
        report.add("largest_distance_percent", 100 * r.distance->largest / box_diagonal(layer),
                   "percent of the diagonal");
    }
    result.report = std::move(report);
    result.layer = std::move(r.mesh);
    result.layer->name = "adaptive " + std::to_string(result.layer->faces.size());
    if (with_positions) result.layer->positions = std::move(r.positions);
    return result;
}

Result adaptive_reconstruction(const Layer& input, const AdaptiveOptions& given, Session& session) {
    require_usable(input.mesh);
    const AdaptiveOptions o = checked(given);
    const bool filter = o.band_gain != 1;
    const Layer changed = filter ? filtered(input, o, session) : Layer();
    const Layer& layer = filter ? changed : input;

    Progress rest = session.progress.part(filter ? 0.4 : 0, 1);
    if (moves_on_the_way(o)) {
        if (std::optional<Result> moved = moving_reconstruction(layer, o, rest.part(0, 0.5))) return std::move(*moved);
        rest = rest.part(0.5, 1);
    }
    const Rings rings = adaptive_rings(layer, o);
    const Hierarchy h = adaptive_hierarchy(layer, rings, o, rest.part(0, 0.6));
    rest.report(0.6, "Measuring the details");
    const Insertion insertion = insertion_order(h, importance(layer, rings, h, o));
    const Reconstructor reconstructor(layer, o, h, insertion);
    const Index base = h.size.back(), least = insertion.count(std::numeric_limits<double>::infinity());
    const double unit = o.unit == LengthUnit::percent ? box_diagonal(layer) / 100 : 1;
    rest.report(0.7, "Choosing the vertices");
    Reconstruction r = [&] {
        switch (o.target) {
        case Target::threshold:
            return reconstructor.make(insertion.count(1), o.measure);
        case Target::faces:
            return reconstructor.make(reconstructor.count_for_faces(least, o.faces), o.measure);
        case Target::vertices:
            return reconstructor.make(
                std::clamp<Index>(std::min(o.vertices, h.vertices()) + h.isolated, least, h.vertices()), o.measure);
        default:
            return fewest_within([&](Index count, const Progress&) { return reconstructor.make(count, true); }, least,
                                 h.vertices(), o.target, o.error * unit, rest.part(0.7, 0.98));
        }
    }();
    rest.report(0.98, "Making the layer");

    Report report;
    report.add("unreferenced_vertices", static_cast<int>(h.isolated));
    report.add("base_faces", reconstructor.base_faces());
    report.add("base_vertices", static_cast<int>(base));
    if (o.target != Target::threshold) {
        const double last = insertion.key[insertion.order[std::max<Index>(r.count, 1) - 1]];
        if (std::isfinite(last)) report_thresholds(o, last, report);
    } else {
        report_thresholds(o, 1, report);
    }
    return result_of(std::move(r), layer, filter || o.fit, std::move(report));
}

}  // namespace multires
