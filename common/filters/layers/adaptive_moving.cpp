#include "filters/layers/adaptive_search.h"
#include "hierarchy/collapse.h"
#include "hierarchy/simplify.h"
#include "mesh/validation.h"

#include <algorithm>

// Adaptive reconstruction whose vertices move while others are removed.

namespace multires {
namespace {

/// Makes reconstructions of one layer.
class Maker {
public:
    Maker(const Layer& layer, const AdaptiveOptions& options, bool measure)
        : layer_(layer), options_(options), measure_(measure), rings_(adaptive_rings(layer, options)) {
        const auto isolated = std::count(rings_.kind.begin(), rings_.kind.end(), RingKind::isolated);
        isolated_ = static_cast<Index>(isolated);
    }

    Index isolated() const { return isolated_; }
    /// Vertices of the input that are in a face.
    Index all() const { return rings_.rows() - isolated_; }

    Reconstruction make(const SimplifyGoal& goal, const Progress& progress) const {
        HierarchyOptions how = adaptive_collapses(options_);
        how.set_share = 0.25;
        Simplified s =
            simplify(layer_.mesh, rings_, how, goal, [&](double f) { progress.report(f, "Removing vertices"); });
        Reconstruction r;
        r.count = static_cast<Index>(s.source_vertex.size()) - isolated_;
        r.mesh.faces = std::move(s.faces);
        r.mesh.source_vertex = std::move(s.source_vertex);
        r.mesh.source_face = std::move(s.source_face);
        r.positions = r.count == all() ? std::move(s.positions)
                                       : fitted(layer_.mesh, r.mesh.faces, s.positions, s.into, on_features(r.mesh));
        if (measure_)
            r.distance = r.count == all()
                             ? Distance()
                             : two_sided_distance(layer_.mesh.faces, layer_.mesh.positions, r.mesh.faces, r.positions);
        return r;
    }

private:
    /// Marks the vertices that features go through.
    std::vector<std::uint8_t> on_features(const DerivedMesh& mesh) const {
        std::vector<std::uint8_t> on(mesh.source_vertex.size(), 0);
        for (std::size_t v = 0; v < on.size(); ++v)
            on[v] = collapse::ring_of(rings_, mesh.source_vertex[v]).features() != 0;
        return on;
    }

    const Layer& layer_;
    const AdaptiveOptions& options_;
    bool measure_;
    Rings rings_;
    Index isolated_ = 0;
};

}  // namespace

bool moves_on_the_way(const AdaptiveOptions& o) {
    const bool target = o.target == Target::faces || o.target == Target::vertices || o.target == Target::rms_distance;
    return o.fit && target && o.criterion == Criterion::area_error && !o.region_of_interest && o.geometry.use &&
           !o.color.use && !o.quality.use && !o.texcoord.use && !o.normal.use;
}

std::optional<Result> moving_reconstruction(const Layer& layer, const AdaptiveOptions& o, const Progress& progress) {
    const bool bound = o.target == Target::rms_distance;
    const Maker maker(layer, o, o.measure || bound);
    std::optional<Reconstruction> r;
    if (o.target == Target::faces) {
        r = maker.make({o.base_vertices, o.faces}, progress);
        const int faces = static_cast<int>(r->mesh.faces.size());
        if (faces > o.faces || faces + 1 < o.faces) return {};  // too few where faces that are there twice counted once
    } else if (o.target == Target::vertices) {
        const Index wanted = std::min(std::max(o.vertices, o.base_vertices), maker.all());
        r = maker.make({wanted, 0}, progress);
        if (r->count > wanted) return {};
    } else {
        const double most = o.error * (o.unit == LengthUnit::percent ? box_diagonal(layer) / 100 : 1);
        bool barred = false;
        const auto make = [&](Index count, const Progress& step) {
            Reconstruction made = maker.make({count, 0}, step);
            barred |= made.count > count;
            return made;
        };
        r = fewest_within(make, std::min<Index>(o.base_vertices, maker.all()), maker.all(), o.target, most, progress);
        if (barred) return {};
    }
    Report report;
    report.add("unreferenced_vertices", static_cast<int>(maker.isolated()));
    return result_of(std::move(*r), layer, true, std::move(report));
}

}  // namespace multires
