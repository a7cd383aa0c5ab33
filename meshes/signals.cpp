#include "base/angles.h"
#include "base/parallel.h"
#include "random.h"
#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace multires::shapes {

namespace {

struct Wave {
    Vec3 frequency;  ///< radians per unit of length
    double phase, amplitude;
};

double height(const std::vector<Wave>& waves, const Vec3& p) {
    double sum = 0;
    for (const Wave& w : waves) sum += w.amplitude * std::cos(w.frequency.dot(p) + w.phase);
    return sum;
}

/// Plane waves of random directions at the wavelengths longest, longest / 2, ... >= shortest. The amplitudes fall with
/// the wavelength to the power 1.2, as those of rough natural surfaces do about.
std::vector<Wave> octaves(double longest, double shortest, double amplitude, Random& random) {
    std::vector<Wave> waves;
    for (double length = longest; length >= shortest; length /= 2) {
        for (int k = 0; k < 4; ++k) {
            waves.push_back({2 * pi / length * random.direction(), random.uniform(0, 2 * pi),
                             amplitude * std::pow(length / longest, 1.2)});
        }
    }
    return waves;
}

/// The colour ramp: water, grass, rock, snow at t = 0, 1/3, 2/3, 1; linear in between.
Vec3 ramp(double t) {
    static const Vec3 stops[4] = {{30, 70, 160}, {60, 140, 50}, {130, 110, 90}, {250, 250, 250}};
    const double at = 3 * std::clamp(t, 0.0, 1.0);
    const int k = std::min(2, static_cast<int>(at));
    return stops[k] + (at - k) * (stops[k + 1] - stops[k]);
}

}  // namespace

std::vector<double> harmonic(const Positions& sphere, Index degree, std::uint64_t seed) {
    Random random(seed);
    Positions directions(16);
    for (Vec3& d : directions) d = random.direction();
    std::vector<double> values(sphere.size());
    double squares = 0;
    for (std::size_t v = 0; v < sphere.size(); ++v) {
        for (std::size_t k = 0; k < directions.size(); ++k) {
            const double x = directions[k].dot(sphere[v]);
            double before = 0, legendre = 1;  // (l + 1) P_l+1 = (2 l + 1) x P_l - l P_l-1
            for (Index l = 0; l < degree; ++l) {
                const double after = ((2 * l + 1) * x * legendre - l * before) / (l + 1);
                before = legendre;
                legendre = after;
            }
            values[v] += k % 2 == 0 ? legendre : -legendre;
        }
        squares += values[v] * values[v];
    }
    const double scale = std::sqrt(static_cast<double>(sphere.size()) / squares);
    for (double& value : values) value *= scale;
    return values;
}

BandedSphere banded_sphere(const BandedSphereOptions& options) {
    BandedSphere result;
    result.mesh = irregular_sphere(options.vertices, options.irregular);
    result.sphere = result.mesh.positions;
    result.low = harmonic(result.sphere, options.low_degree, options.irregular.seed + 1);
    result.high = harmonic(result.sphere, options.high_degree, options.irregular.seed + 2);
    for (std::size_t v = 0; v < result.sphere.size(); ++v) {
        result.low[v] *= options.low_amplitude;
        result.high[v] *= options.high_amplitude;
        result.mesh.positions[v] *= 1 + result.low[v] + result.high[v];
    }
    return result;
}

namespace {

Terrain terrain_on(Mesh flat, Index n, Random random) {
    Terrain result;
    result.mesh = std::move(flat);
    std::vector<Wave> waves = octaves(1, 8.0 / n, 0.03, random);
    for (Wave& w : waves) w.frequency.z() = 0;
    for (Vec3& p : result.mesh.positions) {
        p.z() = height(waves, p);
        const double stripes = std::cos(2 * pi * p.x() * n / 8);
        const Vec3 color = (ramp(0.5 + 4 * p.z()) + Vec3::Constant(12 * stripes)).cwiseMax(0).cwiseMin(255);
        for (int k = 0; k < 3; ++k) result.color.push_back(std::round(color[k]));
        result.color.push_back(255);
        result.texcoord.insert(result.texcoord.end(), {p.x(), p.y()});
        const double front = p.y() > 0.5 + 0.1 * std::sin(2 * pi * p.x()) ? 5 : 0;
        result.scalar.push_back(15 + 10 * std::sin(pi * p.x()) + front);
    }
    return result;
}

}  // namespace

Terrain terrain(Index n, const Irregular& options) {
    return terrain_on(plane(n, options), n, Random(options.seed + 1));
}

Terrain regular_terrain(Index n) {
    GridShape shape;
    shape.rows = shape.columns = n + 1;
    Mesh flat = grid_terrain(shape);
    for (Vec3& p : flat.positions) p = Vec3(p.x() / n, p.y() / n, 0);
    Terrain result = terrain_on(std::move(flat), n, Random(2));
    Random random(3);
    for (Vec3& p : result.mesh.positions) p.z() += random.uniform(-0.05, 0.05) / n;
    return result;
}

Mesh scan(Index vertices, const Irregular& options) {
    Mesh mesh = irregular_sphere(vertices, options);
    Random random(options.seed + 1);
    const double edge = std::sqrt(8 * pi / (std::sqrt(3.0) * static_cast<double>(mesh.positions.size())));
    const std::vector<Wave> waves = octaves(2, 4 * edge, 0.06, random);
    const auto count = static_cast<Index>(mesh.positions.size());
    parallel_for(count, [&](Index v) { mesh.positions[v] *= 1 + height(waves, mesh.positions[v]); });
    return mesh;
}

}  // namespace multires::shapes
