#include "filters/region.h"

#include "base/parallel.h"
#include "measure/measure.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

std::vector<double> selection_weights(const Layer& layer) {
    if (layer.selected_vertex.empty() && layer.selected_face.empty())
        throw InputError("selected: nothing is selected; select vertices or faces, or turn this off");
    std::vector<double> w(layer.mesh.positions.size(), 0);
    for (std::size_t i = 0; i < layer.selected_vertex.size(); ++i) w[i] = layer.selected_vertex[i];
    for (std::size_t f = 0; f < layer.selected_face.size(); ++f)
        if (layer.selected_face[f])
            for (const Index v : layer.mesh.faces[f]) w[v] = 1;
    return w;
}

const std::vector<double>& quality_of(const Layer& layer) {
    for (const Attribute& a : layer.attributes)
        if (a.kind == AttributeKind::quality) return a.values;
    throw InputError("quality_mask: the mesh has no vertex quality");
}

}  // namespace

std::vector<double> region_weights(const Layer& layer, const Region& region) {
    std::vector<double> w;
    if (region.selected) w = selection_weights(layer);
    if (!region.quality_mask) return w;
    const std::vector<double>& quality = quality_of(layer);
    if (w.empty()) w.assign(layer.mesh.positions.size(), 1);
    for (std::size_t i = 0; i < w.size(); ++i) {
        if (std::isnan(quality[i]))
            throw InputError("quality_mask: the quality of vertex " + std::to_string(i) + " is not a number");
        w[i] *= std::clamp(quality[i], 0.0, 1.0);
    }
    return w;
}

void blend(const Positions& before, const std::vector<double>& weights, Positions& after) {
    if (weights.empty()) return;
    parallel_for(static_cast<Index>(before.size()), [&](Index i) {
        if (weights[i] <= 0)
            after[i] = before[i];
        else if (weights[i] < 1)
            after[i] = before[i] + weights[i] * (after[i] - before[i]);
    });
}

void report_change(const Layer& layer, const Positions& after, Report& report) {
    if (!std::all_of(after.begin(), after.end(), [](const Vec3& p) { return p.allFinite(); }))
        throw InputError("The result would have coordinates that are not finite: use smaller gains or fewer steps.");
    const Change c = compare(layer.mesh.faces, layer.mesh.positions, after);
    report.add("largest_displacement", c.displacement.largest, "mesh units");
    report.add("rms_displacement", c.displacement.rms, "mesh units");
    report.add("volume_before", c.before.volume, "cubic mesh units");
    report.add("volume_after", c.after.volume, "cubic mesh units");
    report.add("area_before", c.before.area, "square mesh units");
    report.add("area_after", c.after.area, "square mesh units");
    report.add("centroid_shift", (c.after.centroid - c.before.centroid).norm(), "mesh units");
    report.add("flipped_faces", static_cast<int>(c.flipped_faces));
}

}  // namespace multires
