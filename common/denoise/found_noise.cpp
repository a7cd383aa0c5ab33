#include "denoise/found_noise.h"

#include "base/median.h"
#include "base/reduce.h"
#include "denoise/along_normals.h"
#include "denoise/varying_noise.h"
#include "denoise/weak_impulses.h"
#include "measure/measure.h"
#include "measure/vertex_normals.h"
#include "normals/guided_normals.h"
#include "normals/spikes.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr double certain_if_varying = 0.8;  ///< share of the square of noise that varies

/// True if the vertices that moved stand out of the surface far more than what is left does: a rough surface has spikes
/// of the common kind.
bool stand_out(const Faces& faces, const Positions& before, const Positions& after, const Neighbours& near) {
    const Array<Vec3> normal = vertex_normals(faces, taubin(near, after, 3));
    const std::vector<double> zero(3 * before.size(), 0);
    const std::vector<double> detail = AlongNormals(near, before, normal, {}).detail(zero);
    const std::vector<double> left = AlongNormals(near, after, normal, {}).detail(zero);
    std::vector<double> moved, rest;
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (before[i] != after[i]) moved.push_back(std::abs(detail[3 * i]));
        rest.push_back(std::abs(left[3 * i]));
    }
    return !moved.empty() && lower_quantile(moved, 0.5) > 1.3 * lower_quantile(rest, 0.8);
}

/// Puts back what moved much farther than most did from where a neighbour is, too: the jags of cliffs in a grid stand
/// out as large impulses do, but not alone.
/// @returns  vertices that are still moved
Index put_back_jags(const Positions& before, const Neighbours& near, Positions& after) {
    constexpr double most = 0.8, far = 3.25, beside = 0.5;
    std::vector<double> lengths;
    for (std::size_t i = 0; i < before.size(); ++i)
        if (after[i] != before[i]) lengths.push_back((after[i] - before[i]).norm());
    if (lengths.empty()) return 0;
    const double limit = far * lower_quantile(lengths, most);
    Index left = 0;
    for (Index v = 0; v < near.rows(); ++v) {
        const Vec3 back = before[v] - after[v];
        const auto is_beside = [&](Index w) { return (before[w] - after[v]).dot(back) > beside * back.squaredNorm(); };
        const auto* const ring = near.vertex.data();
        if (back.norm() > limit && std::any_of(ring + near.offset[v], ring + near.offset[v + 1], is_beside))
            after[v] = before[v];
        left += after[v] != before[v];
    }
    return left;
}

/// Noise that differs from place to place is white in most places, or it would not be found.
void set_varying(std::vector<double> deviation, FoundNoise& m) {
    m.deviation = std::move(deviation);
    m.along_normals = rms(m.deviation);
    m.certain = certain_if_varying;
    m.noise.by_edges = 1;
    m.noise.along_normals = m.along_normals;
    m.noise.at_least = std::sqrt(m.certain) * m.along_normals;
}

}  // namespace

int normal_steps(double deviation_in_edges) { return std::clamp(static_cast<int>(100 * deviation_in_edges), 3, 30); }

std::vector<double> deviations(const Faces& faces, const Positions& positions, const Neighbours& near,
                               const SurfaceNoise& noise, double edge) {
    std::vector<double> out(positions.size(), noise.along_normals);
    if (!noise.axis) return out;
    const int steps = normal_steps(noise.axis->deviation / edge);
    const Array<Vec3> normal = vertex_normals(faces, taubin(near, positions, steps));
    for (std::size_t v = 0; v < out.size(); ++v) out[v] = noise.along(normal[v]);
    return out;
}

Positions with_creases(const Faces& faces, const Positions& positions, const Incidence& at,
                       const std::vector<std::uint8_t>& moves) {
    constexpr int steps = 3;
    return guided_steps(faces, positions, at, face_graph(faces, at), steps, moves);
}

Positions without_impulses(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                           Index& spikes) {
    double highest = 0;
    const Positions bent = without_weak_impulses(faces, positions, at, near, highest);
    Positions start = without_spikes(faces, bent, at, spikes);
    if (spikes > 0 && !stand_out(faces, bent, start, near)) start = bent;
    if (highest > 0) start = without_impulses_beside_creases(faces, start, at, near, highest);
    if (start == positions) {
        spikes = 0;
        return start;
    }
    std::vector<std::uint8_t> moves(positions.size());
    for (std::size_t i = 0; i < moves.size(); ++i) moves[i] = start[i] != positions[i];
    const Positions creased = with_creases(faces, start, at, moves);
    for (std::size_t i = 0; i < moves.size(); ++i)  // among slivers it may go far
        if ((creased[i] - start[i]).norm() < (start[i] - positions[i]).norm()) start[i] = creased[i];
    spikes = put_back_jags(positions, near, start);
    return start;
}

void FoundNoise::leave_even_places() {
    if (!rounded || voxels) even = EvenPlaces();
    for (std::size_t v = 0; v < even.silent.size(); ++v)
        if (even.silent[v]) deviation[v] = 0;
}

FoundNoise find_noise(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                      const std::optional<double>& step, const std::optional<double>& known, double edge,
                      const Tick& tick) {
    FoundNoise m;
    std::optional<SurfaceNoise> rounded;
    if (step) {
        m.even = even_places(faces, positions, at, *step, edge);
        rounded = rounding_noise(faces, positions, at, near, m.even.silent, *step, edge);
    }
    m.rounded = rounded.has_value();
    m.voxels = rounded && between_voxels(positions, *step);
    if (m.voxels) {
        // Half a voxel to each side along an edge that the surface crosses, so mostly along its normal.
        rounded->along_normals = rounded->at_least = *step / std::sqrt(3.0);
        rounded->all_directions = false;
    }
    tick(0.05, "Looking for noise that varies");
    std::vector<double> varying;
    if (!rounded && !known) varying = varying_noise(faces, positions, at, near);
    if (!varying.empty()) m.noise = surface_noise(faces, positions, at, near, edge);
    m.varies = !varying.empty() && !m.noise.axis;
    if (m.varies) {
        m.start = positions;
        set_varying(std::move(varying), m);
        if (m.along_normals > 0) find_varying_within_surface(faces, positions, near, m.deviation, m.noise);
        return m;
    }
    tick(0.07, "Looking for impulsive noise");
    m.start = rounded ? positions : without_impulses(faces, positions, at, near, m.spikes);
    tick(0.1, "Measuring the noise");
    m.noise = rounded ? *rounded : surface_noise(faces, m.start, at, near, edge);
    if (known) {
        m.noise.along_normals = m.noise.at_least = *known;
        m.noise.white = m.noise.by_edges = 1;
        m.noise.axis.reset();
    }
    m.deviation = deviations(faces, m.start, near, m.noise, edge);
    m.along_normals = rms(m.deviation);
    m.leave_even_places();
    m.certain = m.along_normals > 0 ? std::pow(m.noise.at_least / m.along_normals, 2) : 0;
    return m;
}

}  // namespace multires
