#include "bands/spline.h"

#include "bands/directions.h"
#include "base/angles.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/number.h"
#include "base/parallel.h"
#include "base/reduce.h"
#include "measure/measure.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace multires {
namespace {

/// Of the residual, for attributes.
constexpr double tolerance = 1e-6;
/// For positions, of the last step's change (its root mean square), in mean edges. What is left of the way to the exact
/// solution is a third of it, at most 2e-4 edges at any vertex: on a sphere of any fineness a normal is off by less
/// than 0.01 degrees.
constexpr double last_change = 2e-5;

SystemOptions system_options(const std::vector<std::uint8_t>& held) {
    SystemOptions options;
    options.stiffness.spread_mass = true;
    options.stiffness.delaunay = true;
    options.fixed = held;
    return options;
}

}  // namespace

ContentHash spline_hash(const Mesh& mesh, const std::vector<std::uint8_t>& held) {
    Hash hash;
    hash.add(shape_hash(mesh.positions, mesh.faces));
    hash.add(held);
    return hash.bits128();
}

void require_carried(double wavelength, const std::string& parameter, double mean_edge) {
    require(std::isfinite(wavelength) && wavelength >= 2 * mean_edge,
            parameter + " must be at least two mean edges, " + number(2 * mean_edge) +
                " mesh units: the mesh carries no shorter waves");
}

Spline::Spline(const Mesh& mesh, const std::vector<std::uint8_t>& held, const Progress& progress)
    : hash_(spline_hash(mesh, held)), mean_edge_(mean_edge_length(mesh.faces, mesh.positions)),
      size_(bounding_box(mesh.positions).diagonal()), system_(mesh, system_options(held), progress) {}

double Spline::stiffness_of(const Cutoff& cutoff, const char* parameter) const {
    require_carried(cutoff.wavelength, parameter, mean_edge_);
    const double k = 2 * pi / std::min(cutoff.wavelength, std::max(2 * mean_edge_, 1000 * size_));
    return 1 / (k * k);
}

void Spline::low_pass(const Cutoff& cutoff, ConstRows f, Rows out, const char* parameter,
                      const Progress& progress) const {
    SolveOptions options;
    options.tolerance = tolerance;
    system_.rational(terms(cutoff.order), stiffness_of(cutoff, parameter), f, out, options, progress);
}

Positions Spline::low_pass(const Mesh& mesh, const Cutoff& cutoff, const char* parameter,
                           const Progress& progress) const {
    Positions smooth(mesh.positions.size());
    SolveOptions options;
    options.tolerance = 1e-9;
    options.together = true;
    options.enough = last_change * mean_edge_;
    system_.rational(terms(cutoff.order), stiffness_of(cutoff, parameter), ConstRows(mesh.positions), Rows(smooth),
                     options, progress.part(0, 0.9));
    progress.report(0.9, "Moving along the normals");
    move_along_normals(mesh, system_.matrices(), smooth);
    return smooth;
}

std::vector<MeasuredTransmission> measure_transmission(const Spline& spline, const Mesh& mesh, const Cutoff& cutoff,
                                                       const std::vector<double>& waves, const Progress& progress) {
    constexpr double steepest = 0.2;  // cosine between axis and normal up to which the surface runs along the axis
    const Index n = static_cast<Index>(mesh.positions.size());
    Positions smooth = mesh.positions;
    spline.low_pass(cutoff, ConstRows(mesh.positions), Rows(smooth), "cutoff", progress.part(0, 0.1));
    const Array<Vec3> normal = directions(mesh.faces, smooth);
    const Vec3 centre = bounding_box(mesh.positions).center();
    std::vector<MeasuredTransmission> all;
    for (std::size_t at = 0; at < waves.size(); ++at) {
        const double k = 2 * pi / waves[at];
        Array<double> f(static_cast<std::size_t>(n) * 6), g(f.size());
        parallel_for(n, [&](Index i) {
            for (int c = 0; c < 3; ++c) {
                const double phase = k * (mesh.positions[i][c] - centre[c]);
                f[6 * static_cast<std::size_t>(i) + 2 * c] = std::cos(phase);
                f[6 * static_cast<std::size_t>(i) + 2 * c + 1] = std::sin(phase);
            }
        });
        const double begin = 0.1 + 0.9 * static_cast<double>(at) / static_cast<double>(waves.size());
        spline.low_pass(cutoff, ConstRows(f, 6), Rows(g, 6), "cutoff",
                        progress.part(begin, begin + 0.9 / static_cast<double>(waves.size())));
        double along = 0, norm = 0, tilt = 0;
        for (Index i = 0; i < n; ++i)
            for (int c = 0; c < 3; ++c) {
                const double cosine = normal[i][c] / steepest;
                if (!(std::abs(cosine) < 1) || normal[i].isZero()) continue;
                const double weight = spline.solver().matrices().mass[i] * (1 - cosine * cosine);
                for (int part = 0; part < 2; ++part) {
                    const std::size_t value = 6 * static_cast<std::size_t>(i) + 2 * c + part;
                    along += weight * f[value] * g[value];
                    norm += weight * f[value] * f[value];
                    tilt += weight * f[value] * f[value] * normal[i][c] * normal[i][c];
                }
            }
        if (!(norm > 0)) continue;
        const double wave = waves[at] / std::sqrt(1 - tilt / norm);
        all.push_back({wave, along / norm, transmission(cutoff.order, cutoff.wavelength, wave)});
    }
    return all;
}

}  // namespace multires
