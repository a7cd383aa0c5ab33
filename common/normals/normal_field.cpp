#include "normals/normal_field.h"

#include "base/median.h"
#include "base/parallel.h"
#include "base/reduce.h"
#include "normals/face_geometry.h"
#include "normals/falling_weight.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

// The constants below were chosen on four noisy scans and CAD parts and checked on others (tools/denoise_bench.py).

/// Tolerated difference of normals: at step k at least wide * narrowing^k times the median difference that is left, and
/// never less than `rest` times the noise at the start (or `most`, where noise is too strong to measure).
constexpr double wide = 3, narrowing = 0.7, rest = 0.68, most = 0.37;
/// Reach of the weights, in mean distances between centroids of faces with a common edge.
constexpr double field_reach = 1.2;
/// Steps after which a snapshot is taken.
constexpr std::array<int, 5> snapshot = {3, 5, 8, 12, 20};
/// Energy of the differences of snapshots over a plane with white noise, in units of the squared median difference of
/// neighbouring normals (measured on an irregular plane with noise of 0.3 edge lengths).
constexpr std::array<double, 4> plane_energy = {0.0111, 0.0032, 0.0009, 0.0006};
/// A detail is noise unless its local energy exceeds this many times that of a plane.
constexpr double significant = 6;
/// Averaging steps that make an energy local.
constexpr int energy_steps = 4;

using Normals = Array<Vec3>;

/// Median difference of the normals of faces with a common edge; 0 without such faces. Faces without a normal do not
/// count.
double median_difference(const FaceGraph& graph, const Normals& n) {
    std::vector<float> d(graph.edges.size());
    parallel_for(static_cast<Index>(d.size()), [&](Index e) {
        const Vec3 &a = n[graph.edges[e][0]], &b = n[graph.edges[e][1]];
        d[e] = a.isZero() || b.isZero() ? -1 : static_cast<float>((a - b).norm());
    });
    d.erase(std::remove(d.begin(), d.end(), -1.0F), d.end());
    if (d.empty()) return 0;
    return upper_median(d);
}

/// One bilateral step. Faces without a normal stay so.
Normals smoothed(const FaceGraph& graph, const std::vector<double>& spatial, const std::vector<double>& area,
                 const Normals& n, double tolerance) {
    const double scale = 1 / (2 * tolerance * tolerance);
    Normals out(n.size());
    parallel_for(static_cast<Index>(n.size()), [&](Index f) {
        const Vec3 own = n[f];
        if (own.isZero()) {
            out[f] = own;
            return;
        }
        Vec3 sum = area[f] * own;
        for (Index k = graph.offset[f]; k < graph.offset[f + 1]; ++k) {
            const Vec3& other = n[graph.neighbor[k]];
            const double exponent = (own - other).squaredNorm() * scale;
            if (exponent < 40) sum += spatial[k] * falling_weight(exponent) * other;
        }
        const double length = sum.norm();
        out[f] = length > 0 ? Vec3(sum / length) : own;
    });
    return out;
}

/// Mean energy of the difference of two fields around each face.
std::vector<double> local_energy(const FaceGraph& graph, const std::vector<double>& area, const Normals& a,
                                 const Normals& b) {
    const Index count = static_cast<Index>(area.size());
    std::vector<double> energy(count), next(count);
    parallel_for(count, [&](Index f) { energy[f] = (a[f] - b[f]).squaredNorm(); });
    for (int step = 0; step < energy_steps; ++step) {
        parallel_for(count, [&](Index f) {
            double sum = area[f] * energy[f], weight = area[f];
            for (Index k = graph.offset[f]; k < graph.offset[f + 1]; ++k) {
                const Index h = graph.neighbor[k];
                sum += area[h] * energy[h];
                weight += area[h];
            }
            next[f] = weight > 0 ? sum / weight : energy[f];
        });
        energy.swap(next);
    }
    return energy;
}

double mean_energy(const Normals& a, const Normals& b) {
    return chunked_fold<Mean>(a.size(), [&](Mean& part, std::size_t f) { part.add((a[f] - b[f]).squaredNorm()); })
        .value();
}

/// Adds to `coarse` what is significant of fine - coarser.
void add_detail(const FaceGraph& graph, const std::vector<double>& area, const Normals& fine, const Normals& coarser,
                double noise_energy, Normals& result, NormalFieldStats& stats) {
    const std::vector<double> energy = local_energy(graph, area, fine, coarser);
    const Normals before = result;
    parallel_for(static_cast<Index>(area.size()), [&](Index f) {
        const double kept = energy[f] > 0 ? std::max(0.0, 1 - significant * noise_energy / energy[f]) : 0;
        result[f] += kept * (fine[f] - coarser[f]);
    });
    const double all = mean_energy(fine, coarser);
    stats.detail_rms.insert(stats.detail_rms.begin(), std::sqrt(all));
    stats.noise_rms.insert(stats.noise_rms.begin(), std::sqrt(noise_energy));
    const double kept = mean_energy(result, before);
    stats.share_removed.insert(stats.share_removed.begin(), all > 0 ? std::max(0.0, 1 - kept / all) : 0);
}

}  // namespace

Array<Vec3> denoise_normals(const Faces& faces, const Positions& positions, const FaceGraph& graph,
                            const NormalFieldOptions& options, NormalFieldStats& stats,
                            const std::function<void(double)>& tick) {
    const FaceGeometry g = face_geometry(faces, positions);
    stats = NormalFieldStats();
    stats.noise = median_difference(graph, g.normal);
    const double noise = options.strength * (options.noise > 0 ? options.noise : stats.noise);
    stats.left = stats.noise;
    if (!(noise > 0)) return g.normal;  // flat, or no two faces meet: there is nothing to take for noise

    const std::vector<double> spatial = spatial_weights(graph, g, field_reach);
    std::vector<Normals> levels;
    Normals n = g.normal;
    double factor = wide * options.strength;
    for (int step = 1; step <= snapshot.back(); ++step, factor *= narrowing) {
        tick(static_cast<double>(step) / snapshot.back());
        const double left = step == 1 ? stats.noise : median_difference(graph, n);
        n = smoothed(graph, spatial, g.area, n, std::max(factor * left, std::min(most, rest * noise)));
        if (std::find(snapshot.begin(), snapshot.end(), step) != snapshot.end()) levels.push_back(n);
    }
    Normals result = levels.back();
    for (std::size_t k = levels.size() - 1; k-- > 0;)
        add_detail(graph, g.area, levels[k], levels[k + 1], plane_energy[k] * noise * noise, result, stats);
    parallel_for(static_cast<Index>(result.size()), [&](Index f) {
        const double length = result[f].norm();
        if (length > 0) result[f] /= length;
    });
    stats.left = median_difference(graph, result);
    return result;
}

}  // namespace multires
