#include "bands/directions.h"

#include "bands/slide.h"
#include "bands/spline.h"
#include "base/parallel.h"
#include "measure/vertex_normals.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace multires {
namespace {

/// cos^2 of the largest turn of a face.
constexpr double least_cosine_square = 0.5;
/// What a step leaves of the part along the surface where faces turn too far, and how near neighbours follow.
constexpr double kept = 0.7, followed = 0.1;
constexpr int most_steps = 30;

/// The area vector of each face and those of all faces around its corners, summed.
struct FaceVectors {
    FaceVectors(const Faces& faces, const Positions& p) : own(faces.size()), around(p.size(), Vec3::Zero()) {
        parallel_for(static_cast<Index>(faces.size()), [&](Index i) { own[i] = area_vector(faces[i], p); });
        for (std::size_t i = 0; i < faces.size(); ++i)
            for (const Index v : faces[i]) around[v] += own[i];
    }
    Vec3 mean(const Face& f) const { return around[f[0]] + around[f[1]] + around[f[2]]; }

    Array<Vec3> own, around;
};

/// How each face should lie: as in the smooth mesh, or, where that has turned a face over among its neighbours (as it
/// may thin ones, within a plane even), along those.
Array<Vec3> upright(const Faces& faces, const Positions& before, const Positions& smooth) {
    const FaceVectors was(faces, before);
    FaceVectors is(faces, smooth);
    parallel_for(static_cast<Index>(faces.size()), [&](Index i) {
        const Vec3 around = is.mean(faces[i]);
        const bool same = was.own[i].dot(was.mean(faces[i])) >= 0;
        if ((is.own[i].dot(around) >= 0) != same) is.own[i] = same ? around : Vec3(-around);
    });
    return std::move(is.own);
}

/// Vertices of faces that are turned too far.
/// @returns  whether there are any
bool mark_turned(const Faces& faces, const Array<Vec3>& upright, const Positions& to, Array<std::uint8_t>& bad_face,
                 Array<std::uint8_t>& bad) {
    parallel_for(static_cast<Index>(faces.size()), [&](Index i) {
        const Vec3 &a = upright[i], b = area_vector(faces[i], to);
        const double dot = a.dot(b);
        bad_face[i] = dot < 0 || dot * dot < least_cosine_square * a.squaredNorm() * b.squaredNorm();
    });
    std::fill(bad.begin(), bad.end(), 0);
    bool any = false;
    for (std::size_t i = 0; i < faces.size(); ++i)
        if (bad_face[i]) {
            any = true;
            for (const Index v : faces[i]) bad[v] = 1;
        }
    return any;
}

}  // namespace

Array<Vec3> directions(const Faces& faces, const Positions& positions) {
    constexpr double cancelled = 0.5;  // share of the area; the corner of a cube has 0.58
    Array<Vec3> sum(positions.size(), Vec3::Zero());
    Array<double> area(positions.size(), 0);
    for (const Face& f : faces) {
        const Vec3 n = area_vector(f, positions);
        const double a = n.norm();
        for (const Index v : f) sum[v] += n, area[v] += a;
    }
    std::vector<std::uint8_t> again(sum.size(), 0);
    for (std::size_t v = 0; v < sum.size(); ++v)
        if (!(sum[v].norm() > cancelled * area[v])) again[v] = 1, sum[v].setZero();
    for (const Face& f : faces) {
        if (!again[f[0]] && !again[f[1]] && !again[f[2]]) continue;
        const Vec3 n = area_vector(f, positions);
        for (const Index v : f)
            if (again[v]) sum[v] += sum[v].dot(n) < 0 ? Vec3(-n) : n;
    }
    for (Vec3& n : sum) {
        const double length = n.norm();
        n = length > 0 && std::isfinite(length) ? Vec3(n / length) : Vec3::Zero();
    }
    return sum;
}

void move_along_normals(const Mesh& mesh, const Stiffness& neighbours, Positions& smooth) {
    const Index n = static_cast<Index>(smooth.size());
    const Array<Vec3> normal = directions(mesh.faces, smooth);
    Positions along(smooth.size()), moved(smooth.size());
    parallel_for(n, [&](Index i) {
        const Vec3 d = smooth[i] - mesh.positions[i];
        along[i] = normal[i].isZero() ? Vec3(Vec3::Zero()) : Vec3(d - normal[i].dot(d) * normal[i]);
        moved[i] = smooth[i] - along[i];
    });
    Array<double> share(smooth.size(), 1), less(smooth.size());
    const Array<Vec3> to = upright(mesh.faces, mesh.positions, smooth);
    Array<std::uint8_t> bad_face(mesh.faces.size()), bad(smooth.size());
    for (int step = 0; step < most_steps && mark_turned(mesh.faces, to, moved, bad_face, bad); ++step) {
        parallel_for(n, [&](Index i) { less[i] = bad[i] ? kept * share[i] : share[i]; });
        parallel_for(n, [&](Index i) {
            double sum = 0;
            const Index begin = neighbours.offset[i], end = neighbours.offset[i + 1];
            for (Index k = begin; k < end; ++k) sum += less[neighbours.column[k]];
            const double mean = begin < end ? sum / (end - begin) : less[i];
            share[i] = std::min(less[i], less[i] + followed * (mean - less[i]));
            moved[i] = smooth[i] - share[i] * along[i];
        });
    }
    slide_back(mesh, neighbours, smooth, moved);
    smooth = std::move(moved);
}

Drift drift(const Faces& faces, const Positions& before, const Positions& after) {
    const Array<Vec3> normal = directions(faces, after);
    Array<double> area(after.size(), 0);
    for (const Face& f : faces) {
        const double a = area_vector(f, after).norm();
        for (const Index v : f) area[v] += a;
    }
    double whole = 0, across = 0, along = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
        const Vec3 d = after[i] - before[i];
        const double part = normal[i].dot(d);
        whole += area[i];
        across += area[i] * part * part;
        along += area[i] * (d - part * normal[i]).squaredNorm();
    }
    if (!(whole > 0)) return {};
    return {std::sqrt(across / whole), std::sqrt(along / whole)};
}

}  // namespace multires
