#include "watermark/carriers.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "base/random.h"
#include "measure/measure.h"
#include "measure/vertex_normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace multires {
namespace {

/// The area vectors of the vertices; where they cancel, as on both sides of a sheet, that of one of the faces.
Array<Vec3> outward(const Mesh& mesh) {
    Array<Vec3> sum = vertex_area_vectors(mesh.faces, mesh.positions);
    for (const Face& f : mesh.faces) {
        const Vec3 area = area_vector(f, mesh.positions);
        for (const Index v : f)
            if (sum[v].squaredNorm() == 0) sum[v] = area;
    }
    return sum;
}

/// The vertices in faces that have an area.
Array<Index> vertices_with_area(const Array<Vec3>& area) {
    Array<Index> used;
    for (std::size_t i = 0; i < area.size(); ++i)
        if (area[i].squaredNorm() > 0) used.push_back(static_cast<Index>(i));
    return used;
}

/// Distances that differ by rounding are the same, so that ties go to the first in order wherever the mesh lies.
constexpr double nearly = 1 - 1e-6;

constexpr Index chunk = 4096;

/// The first of the largest values.
Index first_largest(const std::vector<double>& values) {
    const auto size = static_cast<Index>(values.size());
    std::vector<double> most((values.size() + chunk - 1) / chunk);
    parallel_chunks(size, chunk, [&](Index begin, Index end) {
        most[begin / chunk] = *std::max_element(values.begin() + begin, values.begin() + end);
    });
    const double enough = nearly * *std::max_element(most.begin(), most.end());
    const auto in = std::find_if(most.begin(), most.end(), [&](double m) { return m >= enough; });
    const auto first = values.begin() + (in - most.begin()) * chunk;
    return static_cast<Index>(std::find_if(first, values.end(), [&](double v) { return v >= enough; }) -
                              values.begin());
}

/// Farthest-point sampling, from the point farthest from the mean on; fewer if there are not so many different points.
/// @param spacing  the largest distance of a point to the nearest one chosen
Array<Index> spread_points(const Positions& points, Index count, double& spacing) {
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : points) mean += p;
    mean /= static_cast<double>(points.size());
    std::vector<double> squared(points.size());
    const auto measure = [&](const Vec3& from, bool nearest) {
        parallel_chunks(static_cast<Index>(points.size()), chunk, [&](Index begin, Index end) {
            for (Index i = begin; i < end; ++i) {
                const double d = (points[i] - from).squaredNorm();
                squared[i] = nearest ? std::min(squared[i], d) : d;
            }
        });
        return first_largest(squared);
    };
    Index far = measure(mean, false);
    Array<Index> chosen;
    for (Index c = 0; c < count; ++c) {
        chosen.push_back(far);
        far = measure(points[far], c > 0);
        if (!(squared[far] > 0)) break;
        spacing = std::sqrt(squared[far]);
    }
    return chosen;
}

/// A way from the first point always on to the nearest one left: neighbours are near each other in it, and it turns
/// with the points, as a curve through a grid would not.
std::vector<Index> chain(const Array<Vec3>& points) {
    std::vector<Index> order, left(points.size());
    std::iota(left.begin(), left.end(), 0);
    for (Index at = 0; !left.empty();) {
        const auto far = [&](Index p) { return (points[p] - points[at]).squaredNorm(); };
        double least = far(left[0]);
        for (const Index p : left) least = std::min(least, far(p));
        const auto nearest = std::find_if(left.begin(), left.end(), [&](Index p) { return nearly * far(p) <= least; });
        at = *nearest;
        left.erase(nearest);
        order.push_back(at);
    }
    return order;
}

}  // namespace

Carriers::Carriers(const Mesh& mesh) {
    const Array<Vec3> area = outward(mesh);
    const Array<Index> used = vertices_with_area(area);
    require(!used.empty(), "The mesh has no vertex with a normal to move along");
    Positions points;
    for (const Index i : used) points.push_back(mesh.positions[i]);
    const Array<Index> chosen =
        spread_points(points, std::min(most, static_cast<Index>(used.size() + 1) / 2), spacing_);
    Array<Vec3> place, direction;
    for (const Index c : chosen) {
        const Vec3 normal = area[used[c]].normalized();
        Vec3 mean = Vec3::Zero();
        for (std::size_t i = 0; i < points.size(); ++i) {
            if ((points[i] - points[c]).squaredNorm() > nearly * spacing_ * spacing_) continue;
            const Vec3& a = area[used[i]];
            mean += std::max(0.0, normal.dot(a.normalized())) * a;
        }
        place.push_back(points[c]);
        direction.push_back(mean.normalized());
    }
    for (const Index c : chain(place)) place_.push_back(place[c]), direction_.push_back(direction[c]);
}

double Carriers::value(double squared_ratio) {
    const double r = std::sqrt(squared_ratio), rest = (1 - r) * (1 - r);
    return rest * rest * (4 * r + 1);
}

Array<Vec3> Carriers::displacement(const std::vector<double>& coefficients, const Positions& points) const {
    Array<Vec3> sum(points.size());
    parallel_for(static_cast<Index>(points.size()), [&](Index i) {
        Vec3 moved = Vec3::Zero();
        visit(points[i], [&](Index c, double value) { moved += coefficients[c] * value * direction_[c]; });
        sum[i] = moved;
    });
    return sum;
}

Assignment random_assignment(std::uint64_t seed) {
    Assignment a;
    std::uint64_t counter = seed;
    const auto next = [&] { return random_bits(counter += random_step); };
    for (Index half = 0; half < 2; ++half) {
        std::vector<Index> order(code_bits);
        std::iota(order.begin(), order.end(), 0);
        for (std::size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[next() % (i + 1)]);
        a.bit.insert(a.bit.end(), order.begin(), order.end());
    }
    for (Index c = 0; c < Carriers::most; ++c) a.sign.push_back(next() >> 63 != 0 ? 1 : -1);
    return a;
}

Assignment assignment(const std::string& key) {
    Hash hash;
    hash.add(key);
    return random_assignment(hash.bits64());
}

}  // namespace multires
