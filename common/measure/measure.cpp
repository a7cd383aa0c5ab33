#include "measure/measure.h"

#include "base/angles.h"
#include "base/parallel.h"
#include "base/reduce.h"
#include "measure/angle.h"

#include <cmath>
#include <limits>

namespace multires {

namespace {

constexpr double degenerate = 1e-10;

/// Two edge vectors of a face and their cross product, which is 2 area long.
struct Triangle {
    Triangle(const Face& f, const Positions& p)
        : corner(p[f[0]]), u(p[f[1]] - corner), v(p[f[2]] - corner), cross(u.cross(v)) {}

    double squared_edges() const { return u.squaredNorm() + v.squaredNorm() + (v - u).squaredNorm(); }
    bool is_degenerate() const { return !(cross.norm() > degenerate * squared_edges()); }

    Vec3 corner, u, v, cross;
};

/// Sums over faces from which a Surface is made. Positions are relative to the apex.
struct SurfaceSums {
    double area2 = 0;             ///< twice the area
    double volume6 = 0;           ///< six times the volume
    Vec3 moment6 = Vec3::Zero();  ///< sum of 2 area x (sum of the corners) = 6 x integral of the position

    void add(const Triangle& t, double norm, const Vec3& apex) {
        const Vec3 p = t.corner - apex;
        area2 += norm;
        volume6 += p.dot(t.cross);
        moment6 += norm * (3 * p + t.u + t.v);
    }
    SurfaceSums& operator+=(const SurfaceSums& other) {
        area2 += other.area2;
        volume6 += other.volume6;
        moment6 += other.moment6;
        return *this;
    }
    Surface surface(const Vec3& apex) const {
        const Vec3 centroid = area2 > 0 ? Vec3(apex + moment6 / (3 * area2)) : Vec3(Vec3::Zero());
        return {area2 / 2, volume6 / 6, centroid};
    }
};

struct ChangeSums {
    SurfaceSums before, after;
    Index flipped = 0;

    ChangeSums& operator+=(const ChangeSums& other) {
        before += other.before;
        after += other.after;
        flipped += other.flipped;
        return *this;
    }
};

struct BoxFold {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;

    BoxFold& operator+=(const BoxFold& other) {
        low = low.cwiseMin(other.low);
        high = high.cwiseMax(other.high);
        return *this;
    }
};

struct Qualities {
    Mean mean;
    double least = 1;

    Qualities& operator+=(const Qualities& other) {
        mean += other.mean;
        least = std::min(least, other.least);
        return *this;
    }
};

}  // namespace

Box bounding_box(const Positions& positions) {
    if (positions.empty()) return {};
    const auto fold = chunked_fold<BoxFold>(positions.size(), [&](BoxFold& box, std::size_t v) {
        box += {positions[v], positions[v]};
    });
    return {fold.low, fold.high};
}

double mean_edge_length(const Faces& faces, const Positions& positions) {
    const auto sum = chunked_fold<double>(faces.size(), [&](double& lengths, std::size_t f) {
        const Vec3 &a = positions[faces[f][0]], &b = positions[faces[f][1]], &c = positions[faces[f][2]];
        lengths += (b - a).norm() + (c - b).norm() + (a - c).norm();
    });
    return faces.empty() ? 0 : sum / (3 * static_cast<double>(faces.size()));
}

double edge_spread(const Faces& faces, const Positions& positions) {
    const double mean = mean_edge_length(faces, positions);
    if (!(mean > 0)) return 1;
    const auto sum = chunked_fold<double>(faces.size(), [&](double& squares, std::size_t f) {
        const Vec3 &a = positions[faces[f][0]], &b = positions[faces[f][1]], &c = positions[faces[f][2]];
        squares += ((b - a) / mean).squaredNorm() + ((c - b) / mean).squaredNorm() + ((a - c) / mean).squaredNorm();
    });
    return sum / (3 * static_cast<double>(faces.size()));
}

Surface surface(const Faces& faces, const Positions& positions, const Vec3& apex) {
    const auto sums = chunked_fold<SurfaceSums>(faces.size(), [&](SurfaceSums& part, std::size_t f) {
        const Triangle t(faces[f], positions);
        part.add(t, t.cross.norm(), apex);
    });
    return sums.surface(apex);
}

Surface surface(const Faces& faces, const Positions& positions) {
    return surface(faces, positions, bounding_box(positions).center());
}

Displacement displacement(const Positions& before, const Positions& after) {
    const auto moved = chunked_fold<Lengths>(
        before.size(), [&](Lengths& part, std::size_t v) { part.add((after[v] - before[v]).squaredNorm()); });
    return {moved.largest(), moved.rms()};
}

Change compare(const Faces& faces, const Positions& before, const Positions& after) {
    const Vec3 apex = bounding_box(before).center();
    const auto sums = chunked_fold<ChangeSums>(faces.size(), [&](ChangeSums& part, std::size_t f) {
        const Triangle was(faces[f], before), is(faces[f], after);
        const double norm = was.cross.norm();
        part.before.add(was, norm, apex);
        part.after.add(is, is.cross.norm(), apex);
        part.flipped += was.cross.dot(is.cross) < 0 && norm > degenerate * was.squared_edges();
    });
    return {sums.before.surface(apex), sums.after.surface(apex), displacement(before, after), sums.flipped};
}

Array<Vec3> face_normals(const Faces& faces, const Positions& positions) {
    Array<Vec3> normals(faces.size());
    parallel_for(static_cast<Index>(faces.size()), [&](Index f) {
        const Triangle t(faces[f], positions);
        normals[f] = t.is_degenerate() ? Vec3(Vec3::Zero()) : Vec3(t.cross / t.cross.norm());
    });
    return normals;
}

double mean_normal_angle(const Faces& faces, const Positions& a, const Positions& b) {
    const auto angles = chunked_fold<Mean>(faces.size(), [&](Mean& part, std::size_t f) {
        const Triangle s(faces[f], a), t(faces[f], b);
        if (s.is_degenerate() || t.is_degenerate()) return;
        part.add(angle_between(s.cross, t.cross));
    });
    return degrees(angles.value());
}

TriangleQuality triangle_quality(const Faces& faces, const Positions& positions) {
    if (faces.empty()) return {};
    const auto fold = chunked_fold<Qualities>(faces.size(), [&](Qualities& part, std::size_t f) {
        const Triangle t(faces[f], positions);
        const double squares = t.squared_edges();
        const double quality = squares > 0 ? 2 * std::sqrt(3.0) * t.cross.norm() / squares : 0;
        part.mean.add(quality);
        part.least = std::min(part.least, quality);
    });
    return {fold.mean.value(), fold.least};
}

double rms(const std::vector<double>& values) {
    return chunked_fold<Lengths>(values.size(), [&](Lengths& part, std::size_t i) { part.add(values[i] * values[i]); })
        .rms();
}

}  // namespace multires
