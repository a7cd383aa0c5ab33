#include "filters/shape/denoise_threshold_risk.h"

#include "denoise/risk.h"
#include "denoise/whiteness.h"
#include "measure/measure.h"
#include "measure/vertex_normals.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// The share of the deviation that is believed: none below a whiteness that hardly any sample of noise has.
double believed(double whiteness, Index vertices) {
    constexpr double none = 0.83, all = 0.91;
    const double by_chance = 1.5 / std::sqrt(static_cast<double>(std::max(1, vertices)));
    return std::clamp((whiteness + by_chance - none) / (all - none), 0.0, 1.0);
}

}  // namespace

NoisySurface::NoisySurface(const Mesh& mesh, const Progress& progress) : mesh_(mesh) {
    constexpr double rounding = 1e-4;  // edge lengths: less is no noise
    progress.report(0, "Measuring the noise");
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()));
    near_ = neighbours(mesh.faces, at);
    const double edge = mean_edge_length(mesh.faces, mesh.positions);
    const SurfaceNoise noise = surface_noise(mesh.faces, mesh.positions, at, near_, edge);
    if (!(noise.along_normals > rounding * edge)) return;
    progress.report(0.5, "Measuring the noise");
    const int steps = std::clamp(static_cast<int>(100 * noise.along_normals / edge), 3, 30);
    smooth_ = taubin(near_, mesh.positions, steps);
    normal_ = vertex_normals(mesh.faces, smooth_);
    deviation_ = noise.along_normals * believed(whiteness(near_, mesh.positions, normal_), near_.rows());
    if (!(deviation_ > rounding * edge)) deviation_ = 0;
    if (!(deviation_ > 0)) return;
    progress.report(0.7, "Looking for noise within the surface");
    all_directions_ = relax_within_surface(mesh.faces, mesh.positions, near_, noise, edge).noisy;
    make_probe();
}

void NoisySurface::make_probe() {
    probe_ = Positions(near_.rows(), Vec3::Zero());
    for (Index v = 0; v < near_.rows(); ++v) {
        probe_[v] = deviation_ * gaussian(v, 1) * normal_[v];
        if (!all_directions_ || near_.size(v) == 0) continue;
        const Vec3 edge = smooth_[near_.vertex[near_.offset[v]]] - smooth_[v];
        const Vec3 x = edge - normal_[v] * normal_[v].dot(edge);
        const double length = x.norm();
        if (!(length > 0)) continue;
        probe_[v] += deviation_ / length * (gaussian(v, 2) * x + gaussian(v, 3) * normal_[v].cross(x));
    }
}

NoisySurface::Expected NoisySurface::expected(const Positions& after, const Positions& response) const {
    const std::size_t count = after.size();
    const std::vector<double> deviation(count, deviation_);
    const std::vector<std::uint8_t> core(count, 1);
    const Eigen::VectorXd all = Eigen::VectorXd::Ones(1);
    double edges = 0, heights = 0, noise_edges = 0, noise_heights = 0;
    Response moves(2 * count);
    std::vector<double> probe(count);
    for (int c = 0; c < (all_directions_ ? 3 : 1); ++c) {
        double other = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 axis = all_directions_ ? Vec3::Unit(c) : normal_[i], way = after[i] - mesh_.positions[i];
            probe[i] = axis.dot(probe_[i]);
            moves[2 * i] = axis.dot(way);
            moves[2 * i + 1] = axis.dot(response[i]) - probe[i];
            if (!all_directions_) other += way.squaredNorm() - moves[2 * i] * moves[2 * i];
        }
        const Risks r = risks(near_, {moves}, deviation, probe, core);
        edges += r.edges.at(all);
        heights += r.heights.at(all) + other / static_cast<double>(count);
        noise_edges += r.edges.constant;
        noise_heights += r.heights.constant;
    }
    return {edges / noise_edges, heights / noise_heights};
}

}  // namespace multires
