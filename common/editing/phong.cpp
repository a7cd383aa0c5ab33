#include "editing/phong.h"

#include "base/parallel.h"
#include "editing/proxy.h"
#include "measure/vertex_normals.h"
#include "mesh/incidence.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace multires {
namespace {

/// The face across each side of each face; -1 if there is none, or more than one.
Array<Face> faces_across(const Faces& faces, std::size_t vertices) {
    const Incidence at = vertex_faces(faces, static_cast<Index>(vertices));
    Array<Face> across(faces.size());
    const auto holds = [&](Index face, Index v) {
        const Face& f = faces[face];
        return f[0] == v || f[1] == v || f[2] == v;
    };
    parallel_for(static_cast<Index>(faces.size()), [&](Index f) {
        for (int k = 0; k < 3; ++k) {  // side k is opposite to corner k
            Index a = faces[f][(k + 1) % 3], b = faces[f][(k + 2) % 3];
            if (at[a].size() > at[b].size()) std::swap(a, b);
            Index other = -1, count = 0;
            for (const Index g : at[a])
                if (g != f && holds(g, b)) other = g, ++count;
            across[f][k] = count == 1 ? other : -1;
        }
    });
    return across;
}

/// Weights without the last negative roundings.
Vec3 on_face(const Vec3& w) {
    const Vec3 clamped = w.cwiseMax(0).cwiseMin(1);
    return clamped / clamped.sum();
}

class Search {
public:
    explicit Search(const PhongSurface& surface)
        : surface_(surface), across_(faces_across(surface.faces(), surface.positions().size())) {}

    std::optional<BasePoint> walk(const Vec3& p, Index face) const {
        std::array<Index, 48> seen;
        for (std::size_t n = 0; n < seen.size(); ++n) {
            seen[n] = face;
            Vec3 w;
            if (!root(p, face, w)) return std::nullopt;
            if (w.minCoeff() >= -1e-9) return surface_.over(face, on_face(w), p);
            const auto been = [&](Index f) {
                return std::find(seen.begin(), seen.begin() + n + 1, f) != seen.begin() + n + 1;
            };
            std::array<int, 3> corner = {0, 1, 2};
            std::sort(corner.begin(), corner.end(), [&](int i, int j) { return w[i] < w[j]; });
            Index next = -1;
            int left_across = -1;
            for (const int k : corner) {
                if (w[k] >= 0 || next >= 0) break;
                if (across_[face][k] < 0 && left_across < 0) left_across = k;
                if (across_[face][k] >= 0 && !been(across_[face][k])) next = across_[face][k];
            }
            if (next < 0) return left_across < 0 ? std::nullopt : std::optional(on_border(p, face, left_across));
            face = next;
        }
        return std::nullopt;
    }

private:
    bool root(const Vec3& p, Index face, Vec3& w) const {
        Vec3 corner[3], normal[3];
        for (int k = 0; k < 3; ++k) {
            const Index v = surface_.faces()[face][k];
            corner[k] = surface_.positions()[v] - p;
            normal[k] = surface_.vertex_normal(v);
        }
        return phong_root(corner, normal, w);
    }

    BasePoint on_border(const Vec3& p, Index face, int across) const {
        const Face& f = surface_.faces()[face];
        const Vec3 &a = surface_.positions()[f[(across + 1) % 3]], &b = surface_.positions()[f[(across + 2) % 3]];
        const double length = (b - a).squaredNorm();
        const double t = length > 0 ? std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) : 0;
        Vec3 w = Vec3::Zero();
        w[(across + 1) % 3] = 1 - t, w[(across + 2) % 3] = t;
        BasePoint base = surface_.over(face, w, p);
        base.kind = BaseKind::border;
        return base;
    }

    const PhongSurface& surface_;
    Array<Face> across_;
};

/// The points that no walk from their start has found yet.
void from_the_nearest(const PhongSurface& surface, const Search& search, const Positions& points,
                      Array<BasePoint>& base, const Progress& progress) {
    Array<Index> missing;
    for (std::size_t i = 0; i < base.size(); ++i)
        if (base[i].face < 0) missing.push_back(static_cast<Index>(i));
    if (missing.empty()) return;
    Positions those(missing.size());
    for (std::size_t i = 0; i < those.size(); ++i) those[i] = points[missing[i]];
    const Array<Foot> feet = feet_of(those, surface.faces(), surface.positions(), progress);
    parallel_for(static_cast<Index>(missing.size()), [&](Index i) {
        const Vec3& p = those[i];
        const std::optional<BasePoint> found = search.walk(p, feet[i].face);
        BasePoint& to = base[missing[i]];
        to = found ? *found : surface.over(feet[i].face, feet[i].weight, p);
        if (!found) to.kind = BaseKind::nearest;
    });
}

}  // namespace

PhongSurface::PhongSurface(const Faces& faces, const Positions& positions)
    : faces_(faces), positions_(positions), normal_(vertex_normals(faces, positions)) {}

Vec3 PhongSurface::base(Index face, const Vec3& w) const {
    const Face& f = faces_[face];
    return w[0] * positions_[f[0]] + w[1] * positions_[f[1]] + w[2] * positions_[f[2]];
}

Vec3 PhongSurface::normal(Index face, const Vec3& w) const {
    const Face& f = faces_[face];
    return w[0] * normal_[f[0]] + w[1] * normal_[f[1]] + w[2] * normal_[f[2]];
}

Eigen::Matrix3d PhongSurface::frame(Index face, const Vec3& weight) const {
    const Face& f = faces_[face];
    const Vec3 first = positions_[f[1]] - positions_[f[0]];
    const auto second = [&] { return Vec3(positions_[f[2]] - positions_[f[0]]); };
    constexpr double least = 1e-12;  // squared; less is cancellation
    Vec3 n = normal(face, weight);
    if (!(n.squaredNorm() >= least)) n = first.cross(second());
    n = n.squaredNorm() > 0 ? Vec3(n.normalized()) : Vec3::UnitZ();
    const auto across = [&](const Vec3& side) {
        const Vec3 t = side - side.dot(n) * n;
        return t.squaredNorm() > least * side.squaredNorm() ? Vec3(t.normalized()) : Vec3::Zero();
    };
    Vec3 t = across(first);
    if (t.isZero(0)) t = across(second());
    if (t.isZero(0)) t = n.unitOrthogonal();
    Eigen::Matrix3d axes;
    axes << t, n.cross(t), n;
    return axes;
}

BasePoint PhongSurface::over(Index face, const Vec3& weight, const Vec3& p) const {
    return {face, weight, frame(face, weight).transpose() * (p - base(face, weight)), BaseKind::inside};
}

Vec3 PhongSurface::place(const BasePoint& b) const {
    return base(b.face, b.weight) + frame(b.face, b.weight) * b.detail;
}

bool phong_root(const Vec3 corner[3], const Vec3 normal[3], Vec3& w) {
    constexpr int most = 16;
    const Vec3 side[2] = {corner[0] - corner[2], corner[1] - corner[2]};
    const Vec3 turn[2] = {normal[0] - normal[2], normal[1] - normal[2]};
    const double size = std::sqrt(std::max(side[0].squaredNorm(), side[1].squaredNorm()));
    w.setConstant(1.0 / 3);
    for (int step = 0; step < most; ++step) {
        const Vec3 q = w[0] * corner[0] + w[1] * corner[1] + w[2] * corner[2];
        const Vec3 n = w[0] * normal[0] + w[1] * normal[1] + w[2] * normal[2];
        const Vec3 f = n.cross(q), fu = turn[0].cross(q) + n.cross(side[0]), fv = turn[1].cross(q) + n.cross(side[1]);
        const double uu = fu.squaredNorm(), uv = fu.dot(fv), vv = fv.squaredNorm(), s = uu * vv - uv * uv;
        if (!(s > 1e-14 * uu * vv)) return false;
        double du = (uv * fv.dot(f) - vv * fu.dot(f)) / s, dv = (uv * fu.dot(f) - uu * fv.dot(f)) / s;
        const double length = std::max(std::abs(du), std::abs(dv));
        if (length > 1) du /= length, dv /= length;
        w += Vec3(du, dv, -du - dv);
        if (length < 1e-13 || (step + 1 == most && length < 1e-8))
            return f.norm() <= 1e-8 * n.norm() * (q.norm() + size);
        if (step > 2 && w.minCoeff() < -2) return true;  // far outside: only the direction matters
    }
    return false;
}

BasePoints base_points(const PhongSurface& surface, const Positions& points, const Array<Index>& starts,
                       const Progress& progress) {
    progress.report(0, "Finding base points");
    const Search search(surface);
    BasePoints found;
    found.points.resize(points.size());
    if (!starts.empty())
        parallel_for(static_cast<Index>(points.size()), [&](Index i) {
            if (starts[i] < 0) return;
            if (const auto base = search.walk(points[i], starts[i])) found.points[i] = *base;
        });
    from_the_nearest(surface, search, points, found.points, progress.part(0.5, 1));
    for (const BasePoint& b : found.points) {
        found.border += b.kind == BaseKind::border;
        found.nearest += b.kind == BaseKind::nearest;
    }
    return found;
}

Array<Index> faces_to_start_from(const Faces& faces, std::size_t vertices) {
    Array<Index> start(vertices, -1);
    for (std::size_t f = faces.size(); f-- > 0;)
        if (!repeats_an_index(faces[f]))
            for (const Index v : faces[f]) start[v] = static_cast<Index>(f);
    return start;
}

}  // namespace multires
