#include "base/angles.h"
#include "random.h"
#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace multires::shapes {

namespace {

/// Cuts the quadrilateral a, b, c, d (counterclockwise in its parameters) along a random diagonal, or along the other
/// one if a triangle of the first would get less than a tenth of the area of a unit cell's half.
void cut(Faces& faces, const Index (&corner)[4], const double (&parameter)[4][2], Random& random) {
    const auto area = [&](int i, int j, int k) {
        return (parameter[j][0] - parameter[i][0]) * (parameter[k][1] - parameter[i][1]) -
               (parameter[j][1] - parameter[i][1]) * (parameter[k][0] - parameter[i][0]);
    };
    const bool along_ac = random.chance(0.5);
    const double least = along_ac ? std::min(area(0, 1, 2), area(0, 2, 3)) : std::min(area(0, 1, 3), area(1, 2, 3));
    if (along_ac == (least > 0.1)) {
        faces.push_back({corner[0], corner[1], corner[2]});
        faces.push_back({corner[0], corner[2], corner[3]});
    } else {
        faces.push_back({corner[0], corner[1], corner[3]});
        faces.push_back({corner[1], corner[2], corner[3]});
    }
}

/// The surface of an nx by ny by nz box of unit cells, irregularly tessellated; positions are in cells.
///
/// A coordinate moves only if it may: not off the side it lies on, and not off the planes x = crease.
class Box {
public:
    Box(Index nx, Index ny, Index nz, std::vector<Index> creases, double jitter, std::uint64_t seed)
        : size_{nx, ny, nz}, creases_(std::move(creases)), jitter_(jitter), random_(seed) {}

    Mesh make() {
        for (int axis = 0; axis < 3; ++axis) {
            side(axis, 0);
            side(axis, size_[axis]);
        }
        return std::move(mesh_);
    }

private:
    /// The side where coordinate `axis` is `at`; the other two run in the order that makes it face outwards.
    void side(int axis, Index at) {
        const int u = at > 0 ? (axis + 1) % 3 : (axis + 2) % 3, v = 3 - axis - u;
        for (Index i = 0; i < size_[u]; ++i) {
            for (Index j = 0; j < size_[v]; ++j) {
                Index corner[4];
                double parameter[4][2];
                for (int k = 0; k < 4; ++k) {
                    Index cell[3];
                    cell[axis] = at;
                    cell[u] = i + (k == 1 || k == 2 ? 1 : 0);
                    cell[v] = j + (k >= 2 ? 1 : 0);
                    corner[k] = vertex(cell);
                    parameter[k][0] = mesh_.positions[corner[k]][u];
                    parameter[k][1] = mesh_.positions[corner[k]][v];
                }
                cut(mesh_.faces, corner, parameter, random_);
            }
        }
    }

    Index vertex(const Index (&cell)[3]) {
        const std::int64_t key = (std::int64_t{cell[0]} * (size_[1] + 1) + cell[1]) * (size_[2] + 1) + cell[2];
        const auto [at, is_new] = known_.emplace(key, static_cast<Index>(mesh_.positions.size()));
        if (is_new) {
            Vec3 p(cell[0], cell[1], cell[2]);
            for (int axis = 0; axis < 3; ++axis) {
                const bool fixed =
                    cell[axis] == 0 || cell[axis] == size_[axis] ||
                    (axis == 0 && std::find(creases_.begin(), creases_.end(), cell[0]) != creases_.end());
                if (!fixed) p[axis] += random_.uniform(-jitter_, jitter_);
            }
            mesh_.positions.push_back(p);
        }
        return at->second;
    }

    Index size_[3];
    std::vector<Index> creases_;
    double jitter_;
    Random random_;
    Mesh mesh_;
    std::unordered_map<std::int64_t, Index> known_;
};

/// Height of the block over x: flat, a round groove from x0 to x1 whose walls start at 45 degrees, flat, a ramp from
/// x2 down to half the height at x3, flat.
double profile(double x, double x0, double x1, double x2, double x3) {
    if (x > x0 && x < x1) {
        const double half = (x1 - x0) / 2, radius = half * std::sqrt(2.0), from_middle = x - x0 - half;
        return 1 - (std::sqrt(radius * radius - from_middle * from_middle) - half);
    }
    if (x <= x2) return 1;
    return x < x3 ? 1 - 0.5 * (x - x2) / (x3 - x2) : 0.5;
}

}  // namespace

Mesh plane(Index n, const Irregular& options) {
    Random random(options.seed);
    Mesh mesh;
    for (Index j = 0; j <= n; ++j) {
        for (Index i = 0; i <= n; ++i) {
            const double x = i + (i > 0 && i < n ? random.uniform(-options.jitter, options.jitter) : 0);
            const double y = j + (j > 0 && j < n ? random.uniform(-options.jitter, options.jitter) : 0);
            mesh.positions.emplace_back(x / n, y / n, 0);
        }
    }
    for (Index j = 0; j < n; ++j) {
        for (Index i = 0; i < n; ++i) {
            const Index a = j * (n + 1) + i, corner[4] = {a, a + 1, a + n + 2, a + n + 1};
            double parameter[4][2];
            for (int k = 0; k < 4; ++k) {
                parameter[k][0] = n * mesh.positions[corner[k]].x();
                parameter[k][1] = n * mesh.positions[corner[k]].y();
            }
            cut(mesh.faces, corner, parameter, random);
        }
    }
    flip_edges(mesh, options.flips, random.bits());
    return mesh;
}

Mesh disk(Index rings, const Irregular& options) {
    Random random(options.seed);
    Mesh mesh;
    mesh.positions.emplace_back(0, 0, 0);
    // Ring r has 6 r vertices; of its 6 sectors, each adds 2 r - 1 faces towards ring r - 1.
    const auto vertex = [](Index r, Index k) { return r == 0 ? 0 : 1 + 3 * r * (r - 1) + k % (6 * r); };
    for (Index r = 1; r <= rings; ++r) {
        for (Index k = 0; k < 6 * r; ++k) {
            const double along = k + random.uniform(-options.jitter, options.jitter);
            const double across = r < rings ? random.uniform(-options.jitter, options.jitter) : 0;
            const double angle = 2 * pi * along / (6 * r), radius = (r + across) / rings;
            mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
        }
        for (Index sector = 0; sector < 6; ++sector) {
            for (Index k = 0; k < r; ++k) {
                const Index outer = sector * r + k, inner = sector * (r - 1) + k;
                mesh.faces.push_back({vertex(r, outer), vertex(r, outer + 1), vertex(r - 1, inner)});
                if (k + 1 < r) {
                    mesh.faces.push_back({vertex(r, outer + 1), vertex(r - 1, inner + 1), vertex(r - 1, inner)});
                }
            }
        }
    }
    flip_edges(mesh, options.flips, random.bits());
    return mesh;
}

Mesh irregular_sphere(Index vertices, const Irregular& options) {
    const auto frequency = static_cast<Index>(std::lround(std::sqrt(std::max<Index>(vertices - 2, 10) / 10.0)));
    Mesh mesh = icosphere(frequency);
    Random random(options.seed);
    const double edge = std::sqrt(8 * pi / (std::sqrt(3.0) * static_cast<double>(mesh.positions.size())));
    for (Vec3& p : mesh.positions) {
        const Vec3 tangent = random.direction().cross(p);  // at most 1 long
        p = (p + options.jitter * edge * tangent).normalized();
    }
    flip_edges(mesh, options.flips, random.bits());
    return mesh;
}

Mesh block(Index n, const Irregular& options) {
    const auto cells = [n](double length) { return static_cast<Index>(std::lround(length * n)); };
    const Index x0 = cells(0.6), x1 = cells(1.4), x2 = cells(1.8), x3 = cells(2.4);
    Mesh mesh = Box(3 * n, n, 2 * n, {x0, x1, x2, x3}, options.jitter, options.seed).make();
    const double cell = 1.0 / n;
    for (Vec3& p : mesh.positions) {
        p *= cell;
        p.y() *= profile(p.x(), x0 * cell, x1 * cell, x2 * cell, x3 * cell);
    }
    return mesh;
}

}  // namespace multires::shapes
