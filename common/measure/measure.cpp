#include "measure/measure.h"

#include "base/parallel.h"
#include "base/reduce.h"

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

struct MaxAndSum {
    double largest = 0, sum = 0;

    MaxAndSum& operator+=(const MaxAndSum& other) {
        largest = std::max(largest, other.largest);
        sum += other.sum;
        return *this;
    }
};

struct SumAndCount {
    double sum = 0;
    std::size_t count = 0;

    SumAndCount& operator+=(const SumAndCount& other) {
        sum += other.sum;
        count += other.count;
        return *this;
    }
};

struct QualityFold {
    double sum = 0, least = 1;

    QualityFold& operator+=(const QualityFold& other) {
        sum += other.sum;
        least = std::min(least, other.least);
        return *this;
    }
};

}  // namespace

Box bounding_box(const Positions& positions) {
    if (positions.empty()) return {};
    const auto fold = chunked_reduce<BoxFold>(positions.size(), [&](std::size_t begin, std::size_t end) {
        BoxFold box;
        for (std::size_t v = begin; v < end; ++v) box += BoxFold{positions[v], positions[v]};
        return box;
    });
    return {fold.low, fold.high};
}

double mean_edge_length(const Faces& faces, const Positions& positions) {
    if (faces.empty()) return 0;
    const auto sum = chunked_reduce<double>(faces.size(), [&](std::size_t begin, std::size_t end) {
        double lengths = 0;
        for (std::size_t f = begin; f < end; ++f) {
            const Vec3 &a = positions[faces[f][0]], &b = positions[faces[f][1]], &c = positions[faces[f][2]];
            lengths += (b - a).norm() + (c - b).norm() + (a - c).norm();
        }
        return lengths;
    });
    return sum / (3 * static_cast<double>(faces.size()));
}

Surface surface(const Faces& faces, const Positions& positions, const Vec3& apex) {
    const auto sums = chunked_reduce<SurfaceSums>(faces.size(), [&](std::size_t begin, std::size_t end) {
        SurfaceSums part;
        for (std::size_t f = begin; f < end; ++f) {
            const Triangle t(faces[f], positions);
            part.add(t, t.cross.norm(), apex);
        }
        return part;
    });
    return sums.surface(apex);
}

Surface surface(const Faces& faces, const Positions& positions) {
    return surface(faces, positions, bounding_box(positions).center());
}

Displacement displacement(const Positions& before, const Positions& after) {
    if (before.empty()) return {};
    const auto squares = chunked_reduce<MaxAndSum>(before.size(), [&](std::size_t begin, std::size_t end) {
        MaxAndSum part;
        for (std::size_t v = begin; v < end; ++v) {
            const double square = (after[v] - before[v]).squaredNorm();
            part += {square, square};
        }
        return part;
    });
    return {std::sqrt(squares.largest), std::sqrt(squares.sum / static_cast<double>(before.size()))};
}

Change compare(const Faces& faces, const Positions& before, const Positions& after) {
    const Vec3 apex = bounding_box(before).center();
    const auto sums = chunked_reduce<ChangeSums>(faces.size(), [&](std::size_t begin, std::size_t end) {
        ChangeSums part;
        for (std::size_t f = begin; f < end; ++f) {
            const Triangle was(faces[f], before), is(faces[f], after);
            const double norm = was.cross.norm();
            part.before.add(was, norm, apex);
            part.after.add(is, is.cross.norm(), apex);
            part.flipped += was.cross.dot(is.cross) < 0 && norm > degenerate * was.squared_edges();
        }
        return part;
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
    const auto angles = chunked_reduce<SumAndCount>(faces.size(), [&](std::size_t begin, std::size_t end) {
        SumAndCount part;
        for (std::size_t f = begin; f < end; ++f) {
            const Triangle s(faces[f], a), t(faces[f], b);
            if (s.is_degenerate() || t.is_degenerate()) continue;
            part += {std::atan2(s.cross.cross(t.cross).norm(), s.cross.dot(t.cross)), 1};
        }
        return part;
    });
    return angles.count == 0 ? 0 : angles.sum / static_cast<double>(angles.count) * 180 / std::acos(-1.0);
}

TriangleQuality triangle_quality(const Faces& faces, const Positions& positions) {
    if (faces.empty()) return {};
    const auto fold = chunked_reduce<QualityFold>(faces.size(), [&](std::size_t begin, std::size_t end) {
        QualityFold part;
        for (std::size_t f = begin; f < end; ++f) {
            const Triangle t(faces[f], positions);
            const double squares = t.squared_edges();
            const double quality = squares > 0 ? 2 * std::sqrt(3.0) * t.cross.norm() / squares : 0;
            part += {quality, quality};
        }
        return part;
    });
    return {fold.sum / static_cast<double>(faces.size()), fold.least};
}

double rms(const std::vector<double>& values) {
    if (values.empty()) return 0;
    const auto squares = chunked_reduce<double>(values.size(), [&](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += values[i] * values[i];
        return sum;
    });
    return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace multires
