#include "denoise/edge_fit.h"

#include "base/parallel.h"
#include "measure/angle.h"
#include "measure/vertex_normals.h"

#include <algorithm>
#include <array>

namespace multires {
namespace {

constexpr std::size_t most_pairs = 10000;
constexpr int smoothing_steps = 8;
constexpr double least_cosine = 0.2;  ///< of a turned face and those before; less folds the surface

using HalfEdge = std::array<Index, 3>;  ///< from, to, and the vertex across it

std::vector<HalfEdge> half_edges(const Faces& faces) {
    std::vector<HalfEdge> all;
    all.reserve(3 * faces.size());
    for (const Face& f : faces)
        for (int k = 0; k < 3; ++k) all.push_back({f[k], f[(k + 1) % 3], f[(k + 2) % 3]});
    std::sort(all.begin(), all.end());
    return all;
}

/// The vertex across an edge; -1 if none, or more than one, has it in this direction.
Index across(const std::vector<HalfEdge>& all, Index from, Index to) {
    const auto first = std::lower_bound(all.begin(), all.end(), HalfEdge{from, to, -1});
    const auto is_it = [&](auto at) { return at != all.end() && (*at)[0] == from && (*at)[1] == to; };
    return is_it(first) && !is_it(first + 1) ? (*first)[2] : -1;
}

Vec3 normal_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 n = (b - a).cross(c - a);
    const double length = n.norm();
    return length > 0 ? Vec3(n / length) : Vec3(Vec3::Zero());
}

}  // namespace

EdgeFit::EdgeFit(const Faces& faces) {
    const std::vector<HalfEdge> all = half_edges(faces);
    for (const auto& [a, b, c] : all) {
        if (a > b || across(all, a, b) < 0) continue;
        const Index d = across(all, b, a);
        if (d < 0 || d == c || d == b || c == a || c == b) continue;
        pairs_.push_back({a, b, c, d, 0, 0, 0, 0});
    }
    const std::size_t step = 1 + pairs_.size() / most_pairs;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < pairs_.size(); i += step) pairs_[kept++] = pairs_[i];
    pairs_.resize(kept);
    for (Pair& p : pairs_) {
        p.across_bc = across(all, p.c, p.b);
        p.across_ca = across(all, p.a, p.c);
        p.across_ad = across(all, p.d, p.a);
        p.across_db = across(all, p.b, p.d);
    }
}

double EdgeFit::of(const Positions& p) const {
    double turned = 0, present = 0;
    for (const Pair& e : pairs_) {
        const Vec3 &a = p[e.a], &b = p[e.b], &c = p[e.c], &d = p[e.d];
        const Vec3 left = normal_of(a, b, c), right = normal_of(b, a, d);
        const Vec3 at_b = normal_of(d, b, c), at_a = normal_of(a, d, c), both = left + right;
        if (!(at_b.dot(both) > least_cosine && at_a.dot(both) > least_cosine)) continue;
        const auto side = [&](Index across, const Vec3& from, const Vec3& to, const Vec3& normal) {
            return across < 0 ? 0.0 : (to - from).norm() * angle_between(normal, normal_of(to, from, p[across]));
        };
        present += (a - b).norm() * angle_between(left, right) + side(e.across_bc, b, c, left) +
                   side(e.across_ca, c, a, left) + side(e.across_ad, a, d, right) + side(e.across_db, d, b, right);
        turned += (c - d).norm() * angle_between(at_a, at_b) + side(e.across_bc, b, c, at_b) +
                  side(e.across_ca, c, a, at_a) + side(e.across_ad, a, d, at_a) + side(e.across_db, d, b, at_b);
    }
    return turned + present > 0 ? (turned - present) / (turned + present) : 0;
}

double share_of_noise_by_edges(const Faces& faces, const Positions& positions, const Neighbours& near,
                               const std::vector<double>& deviation) {
    constexpr int samples = 6;
    constexpr double usual = 0.015;  // chance, the shape below, and depth maps cut along the shorter diagonals
    constexpr double shape = 0.04;   // more than that: there is no noise
    const EdgeFit fit(faces);
    const Array<Vec3> normal = vertex_normals(faces, taubin(near, positions, smoothing_steps));
    std::vector<double> h(positions.size(), 0);
    AlongNormals(near, positions, normal, {}).smooth(h, smoothing_steps);
    Positions noisy(positions.size());
    double of_noise = 0;
    for (int sample = 0; sample < samples; ++sample) {
        parallel_for(near.rows(), [&](Index v) {
            noisy[v] = positions[v] + (h[v] + deviation[v] * gaussian(v, 900 + sample)) * normal[v];
        });
        of_noise += fit.of(noisy) / samples;
    }
    return std::clamp(1 - (fit.of(positions) - of_noise - usual) / shape, 0.0, 1.0);
}

}  // namespace multires
