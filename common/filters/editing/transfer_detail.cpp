#include "filters/editing/transfer_detail.h"

#include "base/blocks.h"
#include "base/reduce.h"
#include "editing/phong.h"
#include "filters/editing/proxies.h"
#include "filters/placement.h"
#include "measure/distance.h"
#include "mesh/validation.h"
#include "pyramid/bodies.h"
#include "solvers/system.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace multires {
namespace {

void check(const TransferDetailOptions& o) {
    require(std::isfinite(o.gain), "gain must be a number");
    require(o.largest_distance >= 0 && std::isfinite(o.largest_distance),
            "largest_distance must be a number, 0 or more");
    require(o.finest >= 0 && std::isfinite(o.finest), "finest must be a number, 0 or more");
    require(o.coarsest >= 0 && std::isfinite(o.coarsest), "coarsest must be a number, 0 or more");
    require(o.coarsest == 0 || o.finest < o.coarsest, "finest must be below coarsest");
    const bool letters = std::all_of(o.attribute.begin(), o.attribute.end(),
                                     [](unsigned char c) { return c < 128 && (std::isalnum(c) || c == '_'); });
    require(!o.attribute.empty() && letters, "attribute must be of letters, digits and _");
}

/// The frames of the vertices, as base points over the layer itself.
class VertexFrames {
public:
    explicit VertexFrames(const Mesh& mesh)
        : surface_(mesh.faces, mesh.positions), face_(faces_to_start_from(mesh.faces, mesh.positions.size())) {}

    bool has(Index v) const { return face_[v] >= 0; }
    Vec3 normal(Index v) const { return surface_.vertex_normal(v); }
    Vec3 detail(Index v, const Vec3& target) const { return surface_.over(face_[v], corner(v), target).detail; }
    Vec3 target(Index v, const Vec3& detail) const {
        return surface_.place({face_[v], corner(v), detail, BaseKind::inside});
    }

private:
    Vec3 corner(Index v) const {
        const Face& f = surface_.faces()[face_[v]];
        return {double(f[0] == v), double(f[1] == v), double(f[2] == v)};
    }

    PhongSurface surface_;
    Array<Index> face_;
};

/// Takes over from around vertices that met nothing, falling to 0 over a distance.
void fill(const Mesh& mesh, double distance, const std::vector<std::uint8_t>& met, Positions& detail,
          const Progress& progress) {
    SystemOptions how;
    how.fixed = met;
    const System solver(mesh, how, progress.part(0, 0.5));
    const Positions nothing(detail.size(), Vec3::Zero());
    SolveOptions options;
    options.tolerance = 1e-6;
    solver.solve(1, distance * distance, nothing, detail, options, progress.part(0.5, 1));
}

double turned_over(const Layer& other, const Layer& layer) {
    const auto orientation = [](const Layer& l) { return l.to_world.topLeftCorner<3, 3>().determinant(); };
    return orientation(other) * orientation(layer) < 0 ? -1 : 1;
}

/// Heights at which the normals of the layer meet the other one.
Positions heights(const Layer& layer, const Layer& other, const Positions& surface, const VertexFrames& frames,
                  const TransferDetailOptions& options, Session& session, Report& report) {
    const Positions& p = layer.mesh.positions;
    const SurfaceTree tree(other.mesh.faces, surface);
    const double side = turned_over(other, layer);
    Positions detail(p.size(), Vec3::Zero());
    std::vector<std::uint8_t> met(p.size(), 0);
    parallel_blocks(static_cast<Index>(p.size()), session.progress.part(0.1, 0.6), "Looking for the layer",
                    [&](Index begin, Index end) {
                        for (Index v = begin; v < end; ++v) {
                            if (!frames.has(v) || frames.normal(v) == Vec3::Zero()) continue;
                            const auto hit =
                                tree.nearest_crossing(p[v], side * frames.normal(v), options.largest_distance);
                            if (hit.face >= 0) met[v] = 1, detail[v].z() = side * hit.at;
                        }
                    });
    Index without = 0;
    for (std::size_t v = 0; v < met.size(); ++v) without += frames.has(static_cast<Index>(v)) && !met[v];
    require(std::find(met.begin(), met.end(), 1) != met.end(),
            "layer: no vertex of the current layer meets it within largest_distance along its normal, on a face that "
            "looks to the same side. Move or scale it to where it fits, or check the units");
    report.add("vertices_without", static_cast<int>(without));
    if (without > 0) fill(layer.mesh, options.largest_distance, met, detail, session.progress.part(0.6, 1));
    return detail;
}

Positions detail_of(const Layer& layer, const Layer& other, const VertexFrames& frames,
                    const TransferDetailOptions& options, Session& session, Report& report) {
    require(&other != &layer, "layer: it is the current layer itself; choose another one");
    require_layer(other, "layer");
    const Positions surface = in_layer(other, layer, "the other layer");
    const bool same = same_connectivity(layer.mesh, other.mesh);
    report.say(same ? "Vertices correspond by their numbers." : "Vertices meet the other layer along their normals.");
    if (!same) return heights(layer, other, surface, frames, options, session, report);
    Positions detail(surface.size(), Vec3::Zero());
    parallel_for(static_cast<Index>(surface.size()), [&](Index v) {
        if (frames.has(v)) detail[v] = frames.detail(v, surface[v]);
    });
    report.add("vertices_without", 0);
    return detail;
}

Positions stored(const Layer& layer, const std::string& name) {
    for (const Attribute& a : layer.attributes) {
        if (a.name != name || a.kind != AttributeKind::point || a.width != 3) continue;
        Positions detail(layer.mesh.positions.size());
        for (std::size_t v = 0; v < detail.size(); ++v) {
            detail[v] = Vec3(a.values[3 * v], a.values[3 * v + 1], a.values[3 * v + 2]);
            require(detail[v].allFinite(), "attribute: " + name + " holds values that are not finite");
        }
        return detail;
    }
    throw InputError("use: there is no attribute " + name +
                     " of points in the current layer; store detail there first");
}

/// Leaves only the waves between the limits.
void limit(const Layer& layer, const TransferDetailOptions& options, Positions& detail, Session& session,
           Report& report) {
    if (options.finest == 0 && options.coarsest == 0) return;
    const auto pyramid = pyramid_of(layer, options.pyramid, session, report);
    Field field = field_of(detail);
    field.has_positions = false;
    const Bodies bodies(*pyramid, layer);
    const auto smooth = [&](double wavelength) {
        Band band;
        band.coarsest = wavelength;
        return positions_of(bodies.filter(field, band_gains(bodies, band, box_diagonal(layer), 0)));
    };
    const Positions longer = options.coarsest > 0 ? smooth(options.coarsest) : Positions(detail.size(), Vec3::Zero());
    if (options.finest > 0) detail = smooth(options.finest);
    for (std::size_t v = 0; v < detail.size(); ++v) detail[v] -= longer[v];
}

Positions moved(const Mesh& mesh, const VertexFrames& frames, const Positions& detail) {
    Positions after = mesh.positions;
    parallel_for(static_cast<Index>(after.size()), [&](Index v) {
        if (frames.has(v) && detail[v] != Vec3::Zero()) after[v] = frames.target(v, detail[v]);
    });
    return after;
}

Attribute attribute_of(const std::string& name, const Positions& detail, const std::vector<double>& weights) {
    Attribute a{AttributeKind::point, name, 3, {}};
    for (std::size_t v = 0; v < detail.size(); ++v)
        for (int d = 0; d < 3; ++d) a.values.push_back(weights.empty() ? detail[v][d] : weights[v] * detail[v][d]);
    return a;
}

}  // namespace

Result transfer_detail(const Inputs& inputs, const TransferDetailOptions& options, Session& session) {
    const Layer& layer = inputs.current;
    require_usable(layer.mesh);
    check(options);
    const std::vector<double> weights = region_weights(layer, options.region);
    Result result;
    const Progress whole = session.progress;
    whole.report(0, "Setting up frames");
    const VertexFrames frames(layer.mesh);
    session.progress = whole.part(0.05, 0.6);
    Positions detail = options.use == DetailUse::stored ? stored(layer, options.attribute)
                                                        : detail_of(layer, inputs.other(options.layer, "layer"), frames,
                                                                    options, session, result.report);
    session.progress = whole.part(0.6, 0.9);
    limit(layer, options, detail, session, result.report);
    session.progress = whole;
    whole.report(0.95, "Measuring the change");
    for (Vec3& d : detail) d *= options.gain;
    result.report.add(
        "rms_detail",
        chunked_fold<Lengths>(detail.size(), [&](Lengths& part, std::size_t v) { part.add(detail[v].squaredNorm()); })
            .rms(),
        "mesh units");
    if (options.use == DetailUse::store) {
        result.attributes.push_back(attribute_of(options.attribute, detail, weights));
        return result;
    }
    Positions after = moved(layer.mesh, frames, detail);
    blend(layer.mesh.positions, weights, after);
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    return result;
}

}  // namespace multires
