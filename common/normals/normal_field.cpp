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
/// Exponent of weights from which on a neighbour does not count.
constexpr double negligible = 40;
/// A detail is noise unless its local energy exceeds this many times that of a plane.
constexpr double significant = 6;
/// Averaging steps that make an energy local.
constexpr int energy_steps = 4;

using Normals = Array<Vec3>;

/// Median difference of the normals of faces with a common edge; 0 without such faces. Faces without a normal do not
/// count, nor do silent ones.
double median_difference(const FaceGraph& graph, const Normals& n, const std::vector<std::uint8_t>& silent) {
    std::vector<float> d(graph.edges.size());
    parallel_for(static_cast<Index>(d.size()), [&](Index e) {
        const Vec3 &a = n[graph.edges[e][0]], &b = n[graph.edges[e][1]];
        const bool counts = silent.empty() || !(silent[graph.edges[e][0]] || silent[graph.edges[e][1]]);
        d[e] = a.isZero() || b.isZero() || !counts ? -1 : static_cast<float>((a - b).norm());
    });
    d.erase(std::remove(d.begin(), d.end(), -1.0F), d.end());
    if (d.empty()) return 0;
    return upper_median(d);
}

/// A loop of its own, so that compilers do several at once.
void multiply_by_falling_weights(const double* x, Index count, double* w) {
    for (Index k = 0; k < count; ++k) w[k] *= falling_weight(x[k]);
}

/// Sum of the areas of each face and its neighbours.
std::vector<double> areas_around(const FaceGraph& graph, const std::vector<double>& area) {
    std::vector<double> around(area.size());
    parallel_for(static_cast<Index>(area.size()), [&](Index f) {
        around[f] = area[f];
        for (Index k = graph.offset[f]; k < graph.offset[f + 1]; ++k) around[f] += area[graph.neighbor[k]];
    });
    return around;
}

/// Mean energy of the difference of two fields around each face.
std::vector<double> local_energy(const FaceGraph& graph, const std::vector<double>& area,
                                 const std::vector<double>& around, const Normals& a, const Normals& b) {
    const Index count = static_cast<Index>(area.size());
    std::vector<double> energy(count), weighted(count);
    parallel_for(count, [&](Index f) { energy[f] = (a[f] - b[f]).squaredNorm(); });
    for (int step = 0; step < energy_steps; ++step) {
        parallel_for(count, [&](Index f) { weighted[f] = area[f] * energy[f]; });
        parallel_for(count, [&](Index f) {
            double sum = weighted[f];
            for (Index k = graph.offset[f]; k < graph.offset[f + 1]; ++k) sum += weighted[graph.neighbor[k]];
            if (around[f] > 0) energy[f] = sum / around[f];
        });
    }
    return energy;
}

double mean_energy(const Normals& a, const Normals& b) {
    return chunked_fold<Mean>(a.size(), [&](Mean& part, std::size_t f) { part.add((a[f] - b[f]).squaredNorm()); })
        .value();
}

/// What was added to get `result`, for the report.
void add_statistics(const Normals& fine, const Normals& coarser, double noise_energy, const Normals& before,
                    const Normals& result, NormalFieldStats& stats) {
    const double all = mean_energy(fine, coarser);
    stats.detail_rms.insert(stats.detail_rms.begin(), std::sqrt(all));
    stats.noise_rms.insert(stats.noise_rms.begin(), std::sqrt(noise_energy));
    const double kept = mean_energy(result, before);
    stats.share_removed.insert(stats.share_removed.begin(), all > 0 ? std::max(0.0, 1 - kept / all) : 0);
}

/// Adds to the last level what is significant of the differences of the levels.
Normals with_details(const FaceGraph& graph, const std::vector<double>& area, const std::vector<Normals>& levels,
                     double noise, bool statistics, NormalFieldStats& stats) {
    const std::vector<double> around = areas_around(graph, area);
    Normals result = levels.back();
    for (std::size_t k = levels.size() - 1; k-- > 0;) {
        const Normals &fine = levels[k], &coarser = levels[k + 1];
        const double noise_energy = plane_energy[k] * noise * noise;
        const std::vector<double> energy = local_energy(graph, area, around, fine, coarser);
        const Normals before = statistics ? result : Normals();
        parallel_for(static_cast<Index>(area.size()), [&](Index f) {
            const double kept = energy[f] > 0 ? std::max(0.0, 1 - significant * noise_energy / energy[f]) : 0;
            result[f] += kept * (fine[f] - coarser[f]);
        });
        if (statistics) add_statistics(fine, coarser, noise_energy, before, result, stats);
    }
    return result;
}

}  // namespace

Array<Vec3> bilateral_step(const FaceGraph& graph, const std::vector<double>& spatial, const std::vector<double>& area,
                           const Array<Vec3>& n, double tolerance) {
    const double scale = 1 / (2 * tolerance * tolerance);
    Array<Vec3> out(n.size());
    parallel_chunks(static_cast<Index>(n.size()), 1024, [&](Index begin, Index end) {
        std::vector<double> exponent, weight;
        for (Index f = begin; f < end; ++f) {
            const Vec3 own = n[f];
            out[f] = own;
            if (own.isZero()) continue;
            const Index first = graph.offset[f], count = graph.offset[f + 1] - first;
            const Index* neighbor = graph.neighbor.data() + first;
            exponent.resize(std::max(exponent.size(), static_cast<std::size_t>(count)));
            weight.resize(exponent.size());
            double *x = exponent.data(), *w = weight.data();
            for (Index k = 0; k < count; ++k) {
                x[k] = (own - n[neighbor[k]]).squaredNorm() * scale;
                w[k] = x[k] < negligible ? spatial[first + k] : 0;
                x[k] = std::min(x[k], negligible);
            }
            multiply_by_falling_weights(x, count, w);
            Vec3 sum = area[f] * own;
            for (Index k = 0; k < count; ++k) sum += w[k] * n[neighbor[k]];
            const double length = sum.norm();
            if (length > 0) out[f] = sum / length;
        }
    });
    return out;
}

Array<Vec3> denoise_normals(const Faces& faces, const Positions& positions, const FaceGraph& graph,
                            const NormalFieldOptions& options, NormalFieldStats& stats,
                            const std::function<void(double)>& tick) {
    const FaceGeometry g = face_geometry(faces, positions);
    stats = NormalFieldStats();
    stats.noise = median_difference(graph, g.normal, options.silent);
    const double noise = options.strength * (options.noise > 0 ? options.noise : stats.noise);
    stats.left = stats.noise;
    if (!(noise > 0)) return g.normal;  // flat, or no two faces meet: there is nothing to take for noise

    const std::vector<double> spatial = spatial_weights(graph, g, field_reach);
    std::vector<Normals> levels;
    Normals n = g.normal;
    double factor = wide * options.strength;
    const double resting = std::min(most, rest * noise);
    bool rests = false;  // then it stays there: the factor falls, and hardly ever rises what is left
    for (int step = 1; step <= snapshot.back(); ++step, factor *= narrowing) {
        tick(static_cast<double>(step) / snapshot.back());
        double tolerance = resting;
        if (!rests) {
            const double left = step == 1 ? stats.noise : median_difference(graph, n, options.silent);
            tolerance = std::max(factor * left, resting);
            rests = tolerance == resting;
        }
        n = bilateral_step(graph, spatial, g.area, n, tolerance);
        if (std::find(snapshot.begin(), snapshot.end(), step) != snapshot.end()) levels.push_back(n);
    }
    Normals result = with_details(graph, g.area, levels, noise, options.statistics, stats);
    parallel_for(static_cast<Index>(result.size()), [&](Index f) {
        const double length = result[f].norm();
        if (length > 0) result[f] /= length;
    });
    if (options.statistics) stats.left = median_difference(graph, result, options.silent);
    return result;
}

}  // namespace multires
