#include "denoise/noise.h"

#include "base/parallel.h"
#include "denoise/along_normals.h"
#include "measure/vertex_normals.h"

#include <algorithm>
#include <cmath>

namespace multires {
namespace {

constexpr int local_steps = 6;    ///< averaging that makes an energy local
constexpr int smooth_steps = 20;  ///< more of it for what white noise leaves: a property of the mesh alone
constexpr double spread = 3.5;    ///< see quiet_energy()
constexpr double leak = 0.3;      ///< share of the bends along edges that passes for noise in third differences

double quantile(std::vector<double> values, double share) {
    const auto it = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), it, values.end());
    return *it;
}

/// The energies of a field and of two of white noise, both of them brought to what the mesh makes of it here.
struct Ratios {
    std::vector<double> field, noise, other;
    double at(double share) const {
        const double expected = quantile(noise, share) + quantile(other, share);
        return expected > 0 ? 2 * quantile(field, share) / expected : 0;
    }
};

/// @param energy  #V by 3: of the field, of noise, of other noise
Ratios ratios(const Neighbours& near, std::vector<double> energy) {
    average(near, energy, 3, local_steps);
    std::vector<double> expected(near.rows());
    for (Index v = 0; v < near.rows(); ++v) expected[v] = (energy[3 * v + 1] + energy[3 * v + 2]) / 2;
    average(near, expected, 1, smooth_steps);
    Ratios r;
    for (const bool with_rim : {false, true}) {
        for (Index v = 0; v < near.rows(); ++v) {
            if (!(expected[v] > 0) || (near.rim[v] && !with_rim)) continue;
            r.field.push_back(energy[3 * v] / expected[v]);
            r.noise.push_back(energy[3 * v + 1] / expected[v]);
            r.other.push_back(energy[3 * v + 2] / expected[v]);
        }
        if (!r.field.empty()) break;  // all vertices lie on a rim
    }
    return r;
}

/// 1 for energies that shape could have, 0 for those of strong noise, beside which texture is nothing.
double weakness(double energy, double edge) { return std::clamp((0.1 - std::sqrt(energy) / edge) / 0.07, 0.0, 1.0); }

/// Of white noise that is everywhere, from the ratios of energies: see surface_noise(). The spread that the sample of
/// the mesh has by itself counts for nothing.
double quiet_energy(const Ratios& r, double edge) {
    if (r.field.empty()) return 0;
    const double low = r.at(0.1);
    if (!(low > 0)) return 0;
    const double by_chance = 0.05 + 3 / std::sqrt(static_cast<double>(r.field.size()));
    return low * std::max(0.0, 1 - weakness(low, edge) * spread * std::max(0.0, r.at(0.3) / low - 1 - by_chance));
}

struct Smoothed {
    Positions positions;
    Array<Vec3> normal;
};

Smoothed smoothed(const Faces& faces, const Positions& p, const Neighbours& near, int steps) {
    Smoothed s;
    s.positions = taubin(near, p, steps);
    s.normal = vertex_normals(faces, s.positions);
    return s;
}

/// Energies of details of all channels.
std::vector<double> squares(const std::vector<double>& h) {
    std::vector<double> energy(h.size());
    for (std::size_t i = 0; i < h.size(); ++i) energy[i] = h[i] * h[i];
    return energy;
}

/// Energies that are there everywhere: of first details, which hold the bends of the shape too, and of third ones.
struct Quiet {
    double first = 0, third = 0;
};

/// Small meshes are compared with several samples of noise.
Quiet quiet_energies(const Faces& faces, const Positions& p, const Incidence& at, const Neighbours& near, double edge,
                     int steps) {
    const Smoothed base = smoothed(faces, p, near, steps);
    const AlongNormals surface(near, p, base.normal, cotangent_weights(faces, at, near, base.positions));
    const int repeats = std::clamp(20000 / std::max(1, near.rows()), 1, 8);
    Quiet mean;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        std::vector<double> h(3 * near.rows(), 0);
        for (Index v = 0; v < near.rows(); ++v)
            for (int c = 1; c < 3; ++c) h[3 * v + c] = gaussian(v, 100 + 2 * repeat + c);
        h = surface.detail(h);
        mean.first += quiet_energy(ratios(near, squares(h)), edge) / repeats;
        h = surface.linear_detail(surface.linear_detail(h));
        mean.third += quiet_energy(ratios(near, squares(h)), edge) / repeats;
    }
    return mean;
}

/// Deviation along the normals, mesh units.
double along_normals(const Faces& faces, const Positions& p, const Incidence& at, const Neighbours& near, double edge) {
    Quiet quiet = quiet_energies(faces, p, at, near, edge, 3);
    // Strong noise needs smoother normals.
    if (std::sqrt(quiet.third) > 0.12 * edge) quiet = quiet_energies(faces, p, at, near, edge, 8);
    const double bends = weakness(quiet.third, edge) * leak * leak * std::max(0.0, quiet.first - quiet.third);
    return std::sqrt(std::max(0.0, quiet.third - bends));
}

/// Detail of the places, twice: like AlongNormals::detail with equal weights, for vectors.
Positions second_detail(const Neighbours& near, const Positions& p) {
    Positions from = p, out(p.size());
    for (int order = 0; order < 2; ++order) {
        parallel_for(near.rows(), [&](Index v) {
            Vec3 sum = Vec3::Zero();
            for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) sum += from[v] - from[near.vertex[k]];
            out[v] = near.size(v) > 0 ? Vec3(sum / near.size(v)) : Vec3(Vec3::Zero());
        });
        from.swap(out);
    }
    return from;
}

double within_surface(const Positions& p, const Neighbours& near, const Array<Vec3>& normal) {
    const Positions detail = second_detail(near, p);
    Positions noise(p.size());
    for (Index v = 0; v < near.rows(); ++v) noise[v] = Vec3(gaussian(v, 3), gaussian(v, 4), 0);
    noise = second_detail(near, noise);
    std::vector<double> energy(3 * near.rows());
    for (Index v = 0; v < near.rows(); ++v) {
        const double along = normal[v].dot(detail[v]);
        energy[3 * v] = (detail[v].squaredNorm() - along * along) / 2;
        energy[3 * v + 1] = noise[v].x() * noise[v].x();
        energy[3 * v + 2] = noise[v].y() * noise[v].y();
    }
    const Ratios r = ratios(near, std::move(energy));
    return r.field.empty() ? 0 : std::sqrt(std::max(0.0, r.at(0.1)));
}

}  // namespace

SurfaceNoise surface_noise(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                           double edge) {
    SurfaceNoise noise;
    if (near.rows() == 0 || faces.empty()) return noise;
    if (!(edge > 0)) return noise;
    double& deviation = noise.along_normals;
    deviation = along_normals(faces, positions, at, near, edge);
    deviation *= 1 + 0.12 * std::min(0.5, deviation / edge);  // noise tilts the normals that it is measured along
    // Weak noise is taken for less where few vertices speak for it: too much would harm more than too little.
    const double few = std::min(0.3, 4 / std::sqrt(static_cast<double>(near.rows())));
    deviation *= 1 - few * std::max(0.0, 1 - deviation / (0.07 * edge));
    noise.within_surface = within_surface(positions, near, smoothed(faces, positions, near, 3).normal);
    return noise;
}

}  // namespace multires
