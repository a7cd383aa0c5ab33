#include "filters/shape/denoise.h"

#include "filters/shape/denoise_automatic.h"
#include "filters/shape/denoise_threshold.h"
#include "measure/measure.h"
#include "measure/vertex_normals.h"
#include "mesh/adjacency.h"
#include "mesh/specks.h"
#include "mesh/validation.h"
#include "normals/normal_field.h"
#include "normals/spikes.h"
#include "pyramid/band.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace multires {
namespace {

void check(const DenoiseOptions& o) {
    require(std::isfinite(o.threshold) && o.threshold >= 0, "threshold must be a number, 0 or more");
    require(std::isfinite(o.strength) && o.strength >= 0, "strength must be a number, 0 or more");
    const bool thresholds = o.method == DenoiseMethod::soft_threshold || o.method == DenoiseMethod::hard_threshold;
    require(o.unit != ThresholdUnit::share || (thresholds && o.threshold <= 100),
            "threshold_unit share needs a threshold method, and a threshold of at most 100 percent");
    require(o.finest_level >= 0, "finest_level must be 0 or more");
    require(o.coarsest_level > o.finest_level, "coarsest_level must be more than finest_level");
    require(o.cycle_spins >= 1 && o.cycle_spins <= 64, "cycle_spins must be between 1 and 64");
}

/// How much each vertex is trusted to be without noise, in [0, 1]; empty if not asked for.
std::vector<double> confidence_of(const Layer& layer, const DenoiseOptions& o) {
    if (!o.confidence) return {};
    Region region;
    region.quality_mask = true;
    return region_weights(layer, region);
}

/// The difference of neighbouring normals that noise of this deviation makes, roughly: measured as 1.55 times the
/// deviation in edge lengths where noise is weak; it saturates where it is strong.
double normal_noise(double deviation, double edge) { return edge > 0 ? std::min(0.6, 1.55 * deviation / edge) : 0; }

Positions by_normal_field(const Layer& layer, const DenoiseOptions& o, double given, const Session& session,
                          Report& report) {
    const Mesh& mesh = layer.mesh;
    session.progress.report(0.02, "Finding neighbouring faces");
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()));
    const FaceGraph graph = face_graph(mesh.faces, at);
    session.progress.report(0.06, "Looking for impulsive noise");
    Index spikes = 0;
    const Positions start = o.strength > 0 ? without_spikes(mesh.faces, mesh.positions, at, spikes) : mesh.positions;
    NormalFieldOptions options;
    options.strength = o.strength;
    if (o.unit != ThresholdUnit::automatic)
        options.noise = normal_noise(given, mean_edge_length(mesh.faces, mesh.positions));
    NormalFieldStats stats;
    const Progress smoothing = session.progress.part(0.1, 0.85);
    const Array<Vec3> normals = denoise_normals(mesh.faces, start, graph, options, stats,
                                                [&](double f) { smoothing.report(f, "Denoising the normals"); });
    session.progress.report(0.85, "Fitting the vertices");
    constexpr double rounding = 1e-4;  // of coordinates in single precision; there is nothing to fit then
    constexpr int steps = 8;           // more would follow the normals further and lose volume
    Positions after =
        o.strength > 0 && stats.noise > rounding ? fit_vertices(mesh.faces, start, at, normals, steps) : start;
    report.add("spikes_removed", static_cast<int>(spikes));
    report.add("normal_noise", stats.noise);
    report.add("normal_noise_after", stats.left);
    report.add("detail_per_level", stats.detail_rms);
    report.add("noise_per_level", stats.noise_rms);
    report.add("share_removed", stats.share_removed);
    return after;
}

/// Where volumes are measured from. It makes a difference only if the mesh is open, and then must turn with it: the
/// surface's centroid, where a box would not.
Vec3 apex_of(const Mesh& mesh) {
    Vec3 sum = Vec3::Zero();
    double area = 0;
    for (const Face& f : mesh.faces) {
        const Vec3& a = mesh.positions[f[0]];
        const Vec3 n = (mesh.positions[f[1]] - a).cross(mesh.positions[f[2]] - a);
        sum += n;
        area += n.norm();
    }
    const bool open = sum.norm() > 1e-9 * area;
    return open ? surface(mesh.faces, mesh.positions).centroid : bounding_box(mesh.positions).center();
}

/// Shifts the vertices along their normals, in the measure of their weights, until the volume is what it was; three
/// Newton steps.
void restore_volume(const Mesh& before, const std::vector<double>& weights, Positions& after) {
    const Vec3 apex = apex_of(before);
    const double wanted = surface(before.faces, before.positions, apex).volume;
    for (int step = 0; step < 3; ++step) {
        Array<Vec3> normal = vertex_area_vectors(before.faces, after);
        double sum = 0;
        for (const Vec3& n : normal) sum += n.norm();
        const double nothing = 1e-9 * sum / static_cast<double>(after.size());  // rounding, which has no direction
        // A sixth of the sum is how the volume grows with the vertex.
        double gained = 0;
        for (std::size_t i = 0; i < after.size(); ++i) {
            const double length = normal[i].norm(), weight = weights.empty() ? 1 : weights[i];
            normal[i] = length > nothing ? Vec3(normal[i] * (weight / length)) : Vec3(Vec3::Zero());
            gained += length * weight / 6;
        }
        if (!(gained > 0)) return;
        const double shift = (wanted - surface(before.faces, after, apex).volume) / gained;
        for (std::size_t i = 0; i < after.size(); ++i) after[i] += shift * normal[i];
    }
}

/// Guskov's second-order difference of an edge {i, j} with opposite vertices k and l, divided by what it makes of unit
/// noise: flattened by the hinge map, the segment k-l crosses the line i-j at a point; the difference is that point
/// seen from both. Nothing for degenerate triangles.
std::optional<double> hinge_difference(const Positions& p, Index i, Index j, Index k, Index l) {
    const Vec3 edge = p[j] - p[i];
    const double length = edge.norm();
    if (!(length > 0)) return std::nullopt;
    const Vec3 along = edge / length, a = p[k] - p[i], b = p[l] - p[i];
    const double x = a.dot(along), y = b.dot(along);
    const double height_a = (a - x * along).norm(), height_b = (b - y * along).norm();
    if (height_a < 1e-9 * length || height_b < 1e-9 * length) return std::nullopt;
    const double u = height_b / (height_a + height_b), v = 1 - u, s = (u * x + v * y) / length;
    const Vec3 difference = u * a + v * b - s * edge;
    return difference.norm() / std::sqrt(u * u + v * v + s * s + (1 - s) * (1 - s));
}

}  // namespace

double noise_deviation(const Mesh& mesh) {
    const Rings rings = vertex_rings(mesh);
    std::vector<double> difference;
    for (Index i = 0; i < rings.rows(); ++i) {
        if (rings.kind[i] != RingKind::closed) continue;
        const Index* ring = rings.begin(i);
        const Index size = rings.size(i);
        for (Index j = 0; j < size; ++j)
            if (ring[j] > i)
                if (const auto d =
                        hinge_difference(mesh.positions, i, ring[j], ring[(j + size - 1) % size], ring[(j + 1) % size]))
                    difference.push_back(*d);
    }
    return deviation_by_median(difference);
}

Result denoise(const Layer& layer, const DenoiseOptions& options, Session& session) {
    Result result;
    const Start from(layer, options.relative_to, session, result.report);
    const Layer& start = from.layer();
    require_usable(start.mesh);
    check(options);
    const std::vector<double> weights = region_weights(layer, options.region);
    const std::vector<double> confidence = confidence_of(layer, options);

    const auto large = without_specks(start);
    const Layer& noisy = large ? large->layer : start;
    if (large)
        result.report.say("Specks, parts too small to tell noise from shape, stay as they are: " +
                          std::to_string(large->specks) + ".");
    if (options.method == DenoiseMethod::normal_field)
        result.report.add("noise", noise_deviation(noisy.mesh), "mesh units");
    const double given =
        options.unit == ThresholdUnit::percent ? options.threshold / 100 * box_diagonal(start) : options.threshold;
    std::vector<double> movement = weights;  // how far each vertex may follow, and be shifted
    Positions after;
    if (options.method == DenoiseMethod::automatic || options.method == DenoiseMethod::normal_field) {
        after = options.method == DenoiseMethod::automatic
                    ? by_automatic(noisy, options, given, session, result.report)
                    : by_normal_field(noisy, options, given, session, result.report);
        // Here confidence scales the movement; thresholding takes it as a local threshold.
        std::vector<double> doubt = confidence;
        for (double& c : doubt) c = 1 - c;
        blend(start.mesh.positions, doubt, after);
        if (movement.empty())
            movement = std::move(doubt);
        else
            for (std::size_t i = 0; i < doubt.size(); ++i) movement[i] *= doubt[i];
    } else {
        after = by_threshold(noisy, options, given, confidence, session, result.report);
    }
    blend(layer.mesh.positions, weights, after);
    if (options.keep_volume) {
        Mesh before = start.mesh;
        blend(layer.mesh.positions, weights, before.positions);
        restore_volume(before, movement, after);
    }
    session.progress.report(0.97, "Measuring the change");
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    return result;
}

}  // namespace multires
