#include "filters/analysis/heights.h"

#include "base/angles.h"
#include "base/parallel.h"
#include "base/reduce.h"
#include "filters/analysis/robust_heights.h"
#include "measure/measure.h"
#include "measure/vertex_normals.h"
#include "mesh/adjacency.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace multires {
namespace {

/// Twice the area of a face; 0 if it is degenerate (as in measure/measure.h).
double double_area(const Face& f, const Positions& p) {
    const Vec3 a = p[f[1]] - p[f[0]], b = p[f[2]] - p[f[0]];
    const double area = a.cross(b).norm(), edges = a.squaredNorm() + b.squaredNorm() + (b - a).squaredNorm();
    return area > 1e-10 * edges ? area : 0;
}

struct Moments {
    double weight = 0, absolute = 0, square = 0, cube = 0, fourth = 0;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    Moments& operator+=(const Moments& o) {
        weight += o.weight, absolute += o.absolute, square += o.square, cube += o.cube, fourth += o.fourth;
        low = std::min(low, o.low), high = std::max(high, o.high);
        return *this;
    }
};

struct Slopes {
    double area = 0, square = 0, surface = 0;
    Slopes& operator+=(const Slopes& o) {
        area += o.area, square += o.square, surface += o.surface;
        return *this;
    }
};

/// Squared gradient of a linear function on a face, by its area.
double square_slope(const Face& f, const Positions& p, const std::vector<double>& h, double double_area) {
    Vec3 g = Vec3::Zero();  // turned by a right angle within the face
    for (int k = 0; k < 3; ++k) g += h[f[k]] * (p[f[(k + 2) % 3]] - p[f[(k + 1) % 3]]);
    return g.squaredNorm() / (double_area * double_area);
}

/// Where the vertices stand on the surface `smooth`, seen along its normals.
Positions feet(const Positions& positions, const Positions& smooth, const Array<Vec3>& normal) {
    Positions at(positions.size());
    parallel_for(static_cast<Index>(at.size()),
                 [&](Index i) { at[i] = positions[i] - normal[i].dot(positions[i] - smooth[i]) * normal[i]; });
    return at;
}

/// Takes what a robust low pass holds off raw heights, and their noise.
void make_robust(const Spline& spline, const TextureBand& band, const Array<Vec3>& normal, Heights& heights,
                 const Progress& progress) {
    const std::size_t n = heights.height.size();
    const std::vector<double> base = robust_base(spline, heights.height, vertex_areas(heights.reference), band.order,
                                                 band.coarsest.wavelength, progress.part(0, 0.8));
    if (band.finest.wavelength > 0) {
        const Array<double> raw(heights.height.begin(), heights.height.end());
        Array<double> fine(n);
        spline.low_pass({band.order, band.finest.wavelength}, ConstRows(raw, 1), Rows(fine, 1), band.finest.parameter,
                        progress.part(0.8, 1));
        heights.height.assign(fine.begin(), fine.end());
    }
    parallel_for(static_cast<Index>(n), [&](Index i) {
        heights.height[i] -= base[i];
        heights.reference.positions[i] += base[i] * normal[i];
    });
}

}  // namespace

Heights heights_over_low_pass(const Spline& spline, const Mesh& mesh, const TextureBand& band,
                              const Progress& progress) {
    if (band.finest.wavelength != 0) require_carried(band.finest.wavelength, band.finest.parameter, spline.mean_edge());
    require_carried(band.coarsest.wavelength, band.coarsest.parameter, spline.mean_edge());
    Positions low(mesh.positions.size()), fine = mesh.positions;
    const double beyond_all = 1000 * bounding_box(mesh.positions).diagonal();  // no wave passes, as in Spline
    const auto pass = [&](const Spline& s, const NamedLimit& limit, Positions& out, double begin) {
        const double k = 2 * pi / std::min(limit.wavelength, beyond_all);
        SolveOptions options;
        options.tolerance = 1e-9;
        options.together = true;  // so that a turned mesh gives the same
        s.solver().rational(terms(band.order), 1 / (k * k), mesh.positions, out, options,
                            progress.part(begin, begin + 0.25));
    };
    pass(spline, band.coarsest, low, 0);
    const Mesh smooth{feet(mesh.positions, low, vertex_normals(mesh.faces, low)), mesh.faces};
    const Spline there(smooth, {}, progress.part(0.25, 0.5));
    const Progress last = progress.part(0.75, 1);
    if (band.finest.wavelength > 0 && !band.robust) pass(there, band.finest, fine, 0.5);
    pass(there, band.coarsest, low, band.robust ? 0.5 : 0.75);
    const Array<Vec3> normal = vertex_normals(mesh.faces, low);
    Heights out;
    out.reference = {feet(mesh.positions, low, normal), mesh.faces};
    out.height.resize(fine.size());
    parallel_for(static_cast<Index>(fine.size()), [&](Index i) { out.height[i] = normal[i].dot(fine[i] - low[i]); });
    if (band.robust) make_robust(there, band, normal, out, last);
    return out;
}

std::vector<double> distance_from_rim(const Mesh& mesh, double most) {
    const Rings rings = surface_rings(mesh);
    std::vector<double> distance(mesh.positions.size(), std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> next;
    for (Index v = 0; v < rings.rows(); ++v)
        if (rings.kind[v] == RingKind::open) next.emplace(distance[v] = 0, v);
    while (!next.empty()) {
        const auto [d, v] = next.top();
        next.pop();
        if (d > distance[v] || d > most) continue;
        for (Index j = rings.offset[v]; j < rings.offset[v + 1]; ++j) {
            const Index w = rings.neighbor[j];
            const double there = d + (mesh.positions[v] - mesh.positions[w]).norm();
            if (there < distance[w]) next.emplace(distance[w] = there, w);
        }
    }
    return distance;
}

std::vector<double> vertex_areas(const Mesh& mesh) {
    std::vector<double> area(mesh.positions.size(), 0);
    for (const Face& f : mesh.faces) {
        const double third = double_area(f, mesh.positions) / 6;
        for (const Index v : f) area[v] += third;
    }
    return area;
}

Texture texture_of(const Heights& heights, int bins) {
    const std::vector<double> area = vertex_areas(heights.reference);
    const std::vector<double>& h = heights.height;
    const Mean mean = chunked_fold<Mean>(h.size(), [&](Mean& m, std::size_t i) { m += {area[i] * h[i], area[i]}; });
    Texture t;
    t.mean = mean.value();
    const Moments m = chunked_fold<Moments>(h.size(), [&](Moments& sum, std::size_t i) {
        if (!(area[i] > 0)) return;
        const double d = h[i] - t.mean, square = d * d;
        sum +=
            {area[i], area[i] * std::abs(d), area[i] * square, area[i] * square * d, area[i] * square * square, d, d};
    });
    t.area = m.weight;
    if (!(m.weight > 0)) return t;
    t.sa = m.absolute / m.weight;
    t.sq = std::sqrt(m.square / m.weight);
    t.sp = std::max(0.0, m.high), t.sv = std::max(0.0, -m.low), t.sz = t.sp + t.sv;
    if (t.sq > 0) {
        t.ssk = m.cube / m.weight / (t.sq * t.sq * t.sq);
        t.sku = m.fourth / m.weight / (t.sq * t.sq * t.sq * t.sq);
    }
    const Slopes s = chunked_fold<Slopes>(heights.reference.faces.size(), [&](Slopes& sum, std::size_t f) {
        const Face& face = heights.reference.faces[f];
        const double twice = double_area(face, heights.reference.positions);
        if (!(twice > 0)) return;
        const double square = square_slope(face, heights.reference.positions, h, twice);
        sum += {twice / 2, twice / 2 * square, twice / 2 * square / (std::sqrt(1 + square) + 1)};
    });
    t.sdq = std::sqrt(s.square / s.area);
    t.sdr = 100 * s.surface / s.area;
    for (int b = 0; b <= bins; ++b) t.limits.push_back(-t.sv + t.sz * b / bins);
    t.shares.assign(bins, 0);
    for (std::size_t i = 0; i < h.size(); ++i) {
        if (!(area[i] > 0)) continue;
        const double at = t.sz > 0 ? (h[i] - t.mean + t.sv) / t.sz * bins : 0;
        t.shares[std::clamp(static_cast<int>(at), 0, bins - 1)] += area[i] / m.weight;
    }
    return t;
}

}  // namespace multires
