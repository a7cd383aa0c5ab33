#include "denoise/within_surface.h"

#include "base/parallel.h"
#include "base/reduce.h"
#include "denoise/along_normals.h"
#include "denoise/risk.h"
#include "measure/vertex_normals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace multires {
namespace {

constexpr std::array<int, 5> low_passes = {1, 3, 8, 20, 50};  ///< steps
constexpr std::size_t even_sampling = 3;                      ///< of the low passes: makes the sampling even
constexpr int turning_steps = 10;
constexpr double farthest_turned = 1;  ///< deviations of the noise: what noise has not moved so far is not to come back

/// A face is bad if its normal is turned from that of its vertices by an angle with less than this cosine, or if its
/// area is less than this share of its squared sides (0.577 for equal sides, halved).
struct Bad {
    double cosine, thin;
};

inline Vec3 tangential(const Vec3& v, const Vec3& n) { return v - n * n.dot(v); }

inline Vec3 to_middle(const Neighbours& near, const Positions& p, Index v) {
    Vec3 sum = Vec3::Zero();
    for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) sum += p[near.vertex[k]] - p[v];
    return near.size(v) > 0 ? Vec3(sum / near.size(v)) : sum;
}

bool is_bad(const Face& f, const Positions& p, const Array<Vec3>& normal, const Bad& bad) {
    const Vec3 ab = p[f[1]] - p[f[0]], ac = p[f[2]] - p[f[0]], bc = p[f[2]] - p[f[1]];
    const Vec3 n = ab.cross(ac), wanted = normal[f[0]] + normal[f[1]] + normal[f[2]];
    const double size = n.norm();
    return n.dot(wanted) < bad.cosine * size * wanted.norm() ||
           size < bad.thin * (ab.squaredNorm() + ac.squaredNorm() + bc.squaredNorm());
}

/// Where the smoothed surface bends within a face coarse shapes are folded by nature.
bool is_flat(const Face& f, const Array<Vec3>& normal) {
    constexpr double agreement = 0.95;
    return (normal[f[0]] + normal[f[1]] + normal[f[2]]).norm() > 3 * agreement;
}

/// Numbers of faces.
struct Folded {
    double all = 0;
    double flat = 0;  ///< of those where the surface is flat
    Folded& operator+=(const Folded& o) {
        all += o.all;
        flat += o.flat;
        return *this;
    }
};

Folded folded_faces(const Faces& faces, const Positions& p, const Array<Vec3>& normal) {
    return chunked_reduce<Folded>(faces.size(), [&](std::size_t begin, std::size_t end) {
        Folded part;
        for (std::size_t f = begin; f < end; ++f)
            if (is_bad(faces[f], p, normal, {0.5, 0})) part += {1.0, is_flat(faces[f], normal) ? 1.0 : 0.0};
        return part;
    });
}

/// Vertices of bad faces move half way to the middle of their neighbours, within the surface, until no face is bad or
/// for a few steps. Those on a rim stay.
Positions turned_back(const Faces& faces, Positions p, const Neighbours& near, const Array<Vec3>& normal,
                      const Bad& bad) {
    Positions next = p;
    std::vector<std::uint8_t> moves(p.size()), turn(faces.size());
    for (int step = 0; step < turning_steps; ++step) {
        std::fill(moves.begin(), moves.end(), 0);
        parallel_for(static_cast<Index>(faces.size()), [&](Index f) { turn[f] = is_bad(faces[f], p, normal, bad); });
        for (std::size_t f = 0; f < turn.size(); ++f)
            if (turn[f])
                for (const Index v : faces[f]) moves[v] = 1;
        if (std::find(moves.begin(), moves.end(), 1) == moves.end()) break;
        parallel_for(near.rows(), [&](Index v) {
            next[v] = p[v];
            if (moves[v] && !near.rim[v]) next[v] += 0.5 * tangential(to_middle(near, p, v), normal[v]);
        });
        p.swap(next);
    }
    return p;
}

/// The shifts that Taubin's low passes make within the surface.
/// @param shifts  those that are known, of the first low passes; the others up to `count` are added
void smooth_within(const Positions& p, const Neighbours& near, const Array<Vec3>& normal, std::size_t count,
                   std::vector<Positions>& shifts) {
    Positions q = p, next(p.size());
    int done = 0;
    if (!shifts.empty()) {
        parallel_for(near.rows(), [&](Index v) { q[v] += shifts.back()[v]; });
        done = low_passes[shifts.size() - 1];
    }
    while (shifts.size() < count) {
        const int steps = low_passes[shifts.size()];
        for (; done < steps; ++done)
            for (const double factor : {0.5, -0.53}) {
                parallel_for(near.rows(), [&](Index v) {
                    next[v] = q[v];
                    if (!near.rim[v]) next[v] += factor * tangential(to_middle(near, q, v), normal[v]);
                });
                q.swap(next);
            }
        shifts.emplace_back(p.size());
        parallel_for(near.rows(), [&](Index v) { shifts.back()[v] = q[v] - p[v]; });
    }
}

double mean_product(const Positions& a, const Positions& b) {
    return chunked_reduce<double>(a.size(),
                                  [&](std::size_t begin, std::size_t end) {
                                      double part = 0;
                                      for (std::size_t i = begin; i < end; ++i) part += a[i].dot(b[i]);
                                      return part;
                                  }) /
           static_cast<double>(a.size());
}

/// White noise within the surface, in axes that turn with it.
Positions noise_within(const Positions& p, const Neighbours& near, const Array<Vec3>& normal, double deviation) {
    Positions noise(p.size(), Vec3::Zero());
    parallel_for(near.rows(), [&](Index v) {
        if (near.size(v) == 0) return;
        const Vec3 edge = tangential(p[near.vertex[near.offset[v]]] - p[v], normal[v]);
        const double length = edge.norm();
        if (!(length > 0)) return;
        const Vec3 x = edge / length;
        noise[v] = deviation * (gaussian(v, 5) * x + gaussian(v, 6) * normal[v].cross(x));
    });
    return noise;
}

/// Decides by what the vertices' places and the folded faces say. Noise folds about as many faces of this mesh as it
/// does once the sampling was made even, and more if the sampling is uneven; faces that are folded by nature spoil this
/// where it is weak, so the evidence must be stronger where the sampling alone would explain the places: it must be
/// there without the faces within which the surface bends, too, and not by chance. Where the places are just as
/// irregular as noise makes them everywhere, a few folded faces are enough, which a sampling hardly has.
void judge(const Faces& faces, const Positions& p, const Positions& more, const Positions& to_even,
           const Array<Vec3>& normal, const SurfaceNoise& noise, WithinSurface& out) {
    constexpr double least_share = 0.001, most_share = 0.85, errors = 2, few = 0.2;
    Positions even = p;
    for (std::size_t i = 0; i < p.size(); ++i) even[i] += to_even[i] + more[i];
    const Folded folded = folded_faces(faces, p, normal), expected = folded_faces(faces, even, normal);
    const double irregular = std::clamp((noise.within_surface / noise.along_normals - 1.15) / 0.15, 0.0, 1.0);
    const double flat = most_share * expected.flat + errors * std::sqrt(expected.flat);
    out.noisy = folded.all > least_share * static_cast<double>(faces.size()) &&
                folded.all > (0.6 + 0.6 * irregular) * expected.all &&
                (!(irregular > 0) || folded.flat > irregular * flat);
    out.noisy |= noise.surely_all && folded.flat >= few * expected.flat;
    out.perhaps = !out.noisy && folded.all >= 0.3 * expected.all;
    out.likely = out.perhaps && noise.likely_all && folded.all >= 0.6 * expected.all;
}

void add_blend(const std::vector<Positions>& shift, WithinSurface& out) {
    for (std::size_t k = 0; k < shift.size(); ++k)
        for (std::size_t i = 0; i < shift[k].size(); ++i)
            out.smoothing[i] += out.weights[static_cast<Eigen::Index>(k)] * shift[k][i];
}

/// The blend of the low passes with the least estimated error.
void smooth_noise(const Positions& p, const Positions& noise, const Neighbours& near, const Array<Vec3>& normal,
                  double deviation, std::vector<Positions>& shift, WithinSurface& out) {
    Positions probed = p;
    for (std::size_t i = 0; i < p.size(); ++i) probed[i] += noise[i];
    std::vector<Positions> other;
    smooth_within(p, near, normal, low_passes.size(), shift);
    smooth_within(probed, near, normal, low_passes.size(), other);
    const int count = static_cast<int>(shift.size());
    Risk risk;
    risk.constant = 2 * deviation * deviation;
    risk.linear.resize(count);
    risk.quadratic.resize(count, count);
    const double excess = mean_square(noise) - risk.constant;
    for (int k = 0; k < count; ++k) {
        risk.linear[k] = mean_product(noise, other[k]) - mean_product(noise, shift[k]) + excess;
        for (int l = 0; l <= k; ++l) risk.quadratic(k, l) = risk.quadratic(l, k) = mean_product(shift[k], shift[l]);
    }
    out.weights = least_risk(risk);
    add_blend(shift, out);
    out.before = std::sqrt(risk.constant);
    out.after = std::sqrt(std::max(0.0, risk.at(out.weights)));
}

/// The blend that was found on a sample.
void smooth_as_there(const Positions& p, const Neighbours& near, const Array<Vec3>& normal, const WithinSurface& there,
                     WithinSurface& out) {
    out = there;
    out.smoothing = Positions(p.size(), Vec3::Zero());
    Eigen::Index levels = there.weights.size();
    while (levels > 0 && !(there.weights[levels - 1] > 0)) --levels;
    std::vector<Positions> shift;
    smooth_within(p, near, normal, static_cast<std::size_t>(levels), shift);
    add_blend(shift, out);
}

/// Looks for noise within the surface and for the blend that removes it.
void find_noise(const Faces& faces, const Positions& p, const Neighbours& near, const Array<Vec3>& normal,
                const SurfaceNoise& noise, double edge, WithinSurface& out) {
    const bool judged = noise.maybe_all && noise.along_normals >= 0.08 * edge;
    if (!(noise.all_directions || noise.likely_all || judged)) return;
    const Positions more = noise_within(p, near, normal, noise.along_normals);
    std::vector<Positions> low;
    smooth_within(p, near, normal, even_sampling + 1, low);
    out.noisy = noise.all_directions;
    if (judged && !out.noisy) judge(faces, p, more, low[even_sampling], normal, noise, out);
    if (!judged && noise.surely_all) out.noisy = true;
    if (!judged && !out.noisy) out.perhaps = out.likely = true;
    if (out.noisy || out.perhaps) smooth_noise(p, more, near, normal, noise.along_normals, low, out);
}

}  // namespace

double mean_square(const Positions& p) {
    const double sum = chunked_reduce<double>(p.size(), [&](std::size_t begin, std::size_t end) {
        double part = 0;
        for (std::size_t i = begin; i < end; ++i) part += p[i].squaredNorm();
        return part;
    });
    return p.empty() ? 0 : sum / static_cast<double>(p.size());
}

WithinSurface relax_within_surface(const Faces& faces, const Positions& positions, const Neighbours& near,
                                   const SurfaceNoise& noise, double edge, const WithinSurface* as_there) {
    WithinSurface out;
    out.smoothing = out.turning = Positions(positions.size(), Vec3::Zero());
    const double deviation = noise.along_normals;
    const bool nothing = as_there && as_there->weights.size() == 0 && !as_there->turned;
    if (!(deviation > 0) || nothing) return out;
    const bool weak = deviation < 0.1 * edge;
    const Array<Vec3> normal = vertex_normals(faces, taubin(near, positions, weak ? 8 : 20));
    std::vector<double> h(positions.size(), 0);
    AlongNormals(near, positions, normal, {}).smooth(h, weak ? 5 : 15);
    Positions p = positions;
    for (std::size_t i = 0; i < p.size(); ++i) p[i] += h[i] * normal[i];

    if (as_there)
        smooth_as_there(p, near, normal, *as_there, out);
    else
        find_noise(faces, p, near, normal, noise, edge, out);
    Positions q = p;
    for (std::size_t i = 0; i < p.size(); ++i) q[i] += out.smoothing[i];
    const Positions r =
        turned_back(faces, q, near, normal, out.noisy || deviation > 0.15 * edge ? Bad{0.8, 0.0577} : Bad{0.5, 0.03});
    const double farthest = farthest_turned * deviation;
    out.turning.resize(p.size());
    for (std::size_t i = 0; i < p.size(); ++i) {
        out.turning[i] = r[i] - q[i];
        const double length = out.turning[i].norm();
        if (length > farthest) out.turning[i] *= farthest / length;
        out.turned |= length > 0;
    }
    return out;
}

}  // namespace multires
