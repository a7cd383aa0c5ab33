#pragma once

#include "filters/shape/denoise.h"
#include "measure/distance.h"
#include "measure/measure.h"

#include "filter_fixtures.h"

#include <cmath>
#include <string>
#include <vector>

/// What the tests of denoising share: noise whose size is known, Taubin's smoothing to compare with, and measures of
/// what is left.
namespace multires::fixtures {

inline double gaussian(shapes::Random& random) {
    const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));
    return radius * std::cos(2 * std::acos(-1.0) * random.uniform());
}

/// Unit normals of the vertices, faces weighted by area; 0 for unreferenced vertices.
inline Positions vertex_normals(const Mesh& mesh) {
    Positions normal(mesh.positions.size(), Vec3::Zero());
    for (const Face& f : mesh.faces) {
        const Vec3& a = mesh.positions[f[0]];
        const Vec3 n = (mesh.positions[f[1]] - a).cross(mesh.positions[f[2]] - a);
        for (const Index v : f) normal[v] += n;
    }
    for (Vec3& n : normal)
        if (n.norm() > 0) n.normalize();
    return normal;
}

/// Fractal terrain of edges about 1 long: waves of random directions and phases, the higher the longer they are.
inline Mesh rough_terrain(Index side) {
    shapes::Irregular irregular;
    irregular.jitter = 0.25;
    irregular.flips = 0;
    Mesh mesh = shapes::plane(side, irregular);
    for (Vec3& p : mesh.positions) p *= side;
    shapes::Random random(5);
    for (int wave = 0; wave < 400; ++wave) {
        const double turn = 2 * std::acos(-1.0), shortest = 2;
        const double length = shortest * std::pow(side / shortest, random.uniform());
        const double direction = turn * random.uniform(), phase = turn * random.uniform();
        const Vec3 frequency = turn / length * Vec3(std::cos(direction), std::sin(direction), 0);
        for (Vec3& p : mesh.positions)
            p.z() += 0.03 * std::pow(length, 0.6) * std::sin(frequency.x() * p.x() + frequency.y() * p.y() + phase);
    }
    return mesh;
}

enum class NoiseKind {
    along_normals,   ///< Gaussian, along the vertex normals
    all_directions,  ///< Gaussian in each coordinate
    impulsive,       ///< along the normals, at one vertex in seven only
};

/// @param deviation  of the noise (where there is some), mean edge lengths
inline Positions with_noise(const Mesh& mesh, double deviation, NoiseKind kind = NoiseKind::along_normals,
                            std::uint64_t seed = 1) {
    shapes::Random random(seed);
    const double size = deviation * mean_edge_length(mesh.faces, mesh.positions);
    const Positions normal = vertex_normals(mesh);
    Positions noisy = mesh.positions;
    for (std::size_t i = 0; i < noisy.size(); ++i) {
        if (kind == NoiseKind::all_directions) {
            for (int k = 0; k < 3; ++k) noisy[i][k] += size * gaussian(random);
        } else if (kind == NoiseKind::along_normals || random.chance(1 / 7.0)) {
            noisy[i] += size * gaussian(random) * normal[i];
        }
    }
    return noisy;
}

inline Positions denoised(const Mesh& mesh, const DenoiseOptions& options = {}) {
    Session session;
    return *denoise(layer_of(mesh), options, session).positions;
}

/// Taubin's lambda-mu smoothing with the umbrella operator (1995), as everybody has it.
inline Positions taubin(const Mesh& mesh, Positions p, int steps) {
    std::vector<std::vector<Index>> around(p.size());
    for (const Face& f : mesh.faces)
        for (int k = 0; k < 3; ++k)
            for (int l = 1; l < 3; ++l) around[f[k]].push_back(f[(k + l) % 3]);
    const auto step = [&](double factor) {
        Positions next = p;
        for (std::size_t i = 0; i < p.size(); ++i) {
            if (around[i].empty()) continue;
            Vec3 sum = Vec3::Zero();
            for (const Index j : around[i]) sum += p[j];
            next[i] += factor * (sum / static_cast<double>(around[i].size()) - p[i]);
        }
        p.swap(next);
    };
    for (int i = 0; i < steps; ++i) {
        step(0.5);
        step(-0.53);
    }
    return p;
}

/// How far a surface is from the true one.
struct Error {
    double angle;   ///< mean angle between normals, degrees
    double rms;     ///< of the vertices' distance to the true surface, mean edge lengths of the truth
    double volume;  ///< relative change
    Index folded;   ///< faces turned by more than 90 degrees
};

class Truth {
public:
    explicit Truth(const Mesh& mesh)
        : mesh_(mesh), tree_(mesh.faces, mesh.positions), edge_(mean_edge_length(mesh.faces, mesh.positions)),
          face_of_(mesh.positions.size(), -1) {
        for (std::size_t f = 0; f < mesh.faces.size(); ++f)
            for (const Index v : mesh.faces[f]) face_of_[v] = static_cast<Index>(f);
    }

    Error error_of(const Positions& p) const {
        const Change change = compare(mesh_.faces, mesh_.positions, p);
        double sum = 0;
        for (std::size_t i = 0; i < p.size(); ++i) sum += tree_.closest(p[i], face_of_[i]).squared;
        return {mean_normal_angle(mesh_.faces, mesh_.positions, p), std::sqrt(sum / p.size()) / edge_,
                change.after.volume / change.before.volume - 1, change.flipped_faces};
    }

    /// The least angle and the least distance that Taubin's smoothing reaches with any of these numbers of steps.
    Error best_taubin(const Positions& noisy) const {
        Error best{180, 1e300, 0, 0};
        for (const int steps : {5, 10, 20, 40, 70}) {
            const Error e = error_of(taubin(mesh_, noisy, steps));
            best.angle = std::min(best.angle, e.angle);
            best.rms = std::min(best.rms, e.rms);
        }
        return best;
    }

private:
    const Mesh& mesh_;
    SurfaceTree tree_;
    double edge_;
    std::vector<Index> face_of_;
};

inline Error error_of(const Mesh& truth, const Positions& p) { return Truth(truth).error_of(p); }
inline Error best_taubin(const Mesh& truth, const Positions& noisy) { return Truth(truth).best_taubin(noisy); }

}  // namespace multires::fixtures
