#include "filters/shape/denoise_threshold_risk.h"

#include "base/reduce.h"
#include "denoise/automatic.h"
#include "denoise/risk.h"
#include "denoise/white_share.h"
#include "measure/measure.h"
#include "measure/vertex_normals.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

/// Sums of risks of one candidate.
struct Sum {
    double constant = 0, linear = 0, quadratic = 0;

    void add(const Risk& r) { constant += r.constant, linear += r.linear[0], quadratic += r.quadratic(0, 0); }
    /// The largest share of the move that gains even if there is only this share of the noise's variance.
    double safe_share(double certain) const {
        return quadratic > 0 ? std::clamp(-2 * certain * linear / quadratic, 0.0, 1.0) : 0;
    }
    /// Of a share of the move, over that of none.
    double at(double share) const { return 1 + share * (2 * linear + share * quadratic) / constant; }
};

}  // namespace

NoisySurface::NoisySurface(const Mesh& mesh, const Progress& progress) : mesh_(mesh) {
    constexpr double rounding = 1e-4;  // edge lengths: less is no noise
    progress.report(0, "Measuring the noise");
    const Incidence at = vertex_faces(mesh.faces, static_cast<Index>(mesh.positions.size()));
    near_ = neighbours(mesh.faces, at);
    const double edge = mean_edge_length(mesh.faces, mesh.positions);
    noise_ = surface_noise(mesh.faces, mesh.positions, at, near_, edge);
    if (!(noise_.at_least > rounding * edge)) return;
    progress.report(0.5, "Measuring the noise");
    const double strongest = noise_.axis ? noise_.axis->deviation : noise_.along_normals;
    const int steps = std::clamp(static_cast<int>(100 * strongest / edge), 3, 30);
    smooth_ = taubin(near_, mesh.positions, steps);
    normal_ = vertex_normals(mesh.faces, smooth_);
    Mean square;
    for (const Vec3& n : normal_) {
        deviations_.push_back(noise_.along(n));
        square.add(deviations_.back() * deviations_.back());
    }
    deviation_ = std::sqrt(square.value());
    if (!(deviation_ > 0)) return;
    progress.report(0.7, "Looking for noise within the surface");
    all_directions_ = relax_within_surface(mesh.faces, mesh.positions, near_, noise_, edge).noisy;
    make_probe();
    const Progress part = progress.part(0.75, 1);
    AutomaticOptions options;
    options.fast = true;
    AutomaticStats stats;
    likely_ = denoise_automatically(mesh.faces, mesh.positions, options, stats,
                                    [&](double f, const char* what) { part.report(f, what); });
}

double NoisySurface::nearest_share(const Positions& after) const {
    /// Products of two moves, summed.
    struct Products {
        double likely = 0, own = 0;
        void add(const Vec3& move, const Vec3& likely_move) {
            likely += move.dot(likely_move), own += move.squaredNorm();
        }
        Products& operator+=(const Products& o) {
            likely += o.likely, own += o.own;
            return *this;
        }
        double share() const { return own > 0 ? std::clamp(likely / own, 0.0, 1.0) : 0; }
    };
    const Positions& from = mesh_.positions;
    const auto vertices = chunked_fold<Products>(
        from.size(), [&](Products& sum, std::size_t v) { sum.add(after[v] - from[v], likely_[v] - from[v]); });
    const auto edges = chunked_fold<Products>(from.size(), [&](Products& sum, std::size_t v) {
        for (Index k = near_.offset[v]; k < near_.offset[v + 1]; ++k) {
            const std::size_t w = static_cast<std::size_t>(near_.vertex[k]);
            const Vec3 difference = from[v] - from[w];
            sum.add(after[v] - after[w] - difference, likely_[v] - likely_[w] - difference);
        }
    });
    return std::min(vertices.share(), edges.share());
}

void NoisySurface::make_probe() {
    probe_ = Positions(near_.rows(), Vec3::Zero());
    for (Index v = 0; v < near_.rows(); ++v) {
        probe_[v] = deviations_[v] * gaussian(v, 1) * normal_[v];
        if (!all_directions_ || near_.size(v) == 0) continue;
        const Vec3 edge = smooth_[near_.vertex[near_.offset[v]]] - smooth_[v];
        const Vec3 x = edge - normal_[v] * normal_[v].dot(edge);
        const double length = x.norm();
        if (!(length > 0)) continue;
        probe_[v] += deviation_ / length * (gaussian(v, 2) * x + gaussian(v, 3) * normal_[v].cross(x));
    }
}

double NoisySurface::certain(const Positions& after, const Positions& response) const {
    Response moves(2 * after.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
        moves[2 * i] = normal_[i].dot(after[i] - mesh_.positions[i]);
        moves[2 * i + 1] = normal_[i].dot(response[i] - probe_[i]);
    }
    const double removed = white_share_removed(AlongNormals(near_, mesh_.positions, normal_, {}), near_, {moves},
                                               Eigen::VectorXd::Ones(1), std::vector<std::uint8_t>(after.size(), 1));
    return std::pow(noise_.at_least / deviation_, 2) * std::max(noise_.white, removed);
}

NoisySurface::Expected NoisySurface::expected(const Positions& after, const Positions& response) const {
    const std::size_t count = after.size();
    const std::vector<std::uint8_t> core(count, 1);
    Sum edges, heights;
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
        const Risks r = risks(near_, {moves}, deviations_, probe, core);
        edges.add(r.edges);
        heights.add(r.heights);
        heights.quadratic += other / static_cast<double>(count);
    }
    const double least = certain(after, response);
    const double share = std::min(edges.safe_share(least), heights.safe_share(least));
    return {edges.at(share), heights.at(share), share};
}

}  // namespace multires
