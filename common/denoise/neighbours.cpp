#include "denoise/neighbours.h"

#include "base/angles.h"
#include "base/parallel.h"
#include "base/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace multires {
namespace {

/// The neighbours of one vertex, once for each of its faces that has them; ascending.
void corners_around(const Faces& faces, const Incidence& at, Index v, std::vector<Index>& found) {
    found.clear();
    for (const Index face : at[v])
        for (const Index w : faces[face])
            if (w != v) found.push_back(w);
    std::sort(found.begin(), found.end());
}

double limited_cotangent(const Vec3& a, const Vec3& b) {
    const double dot = a.dot(b), cross = a.cross(b).norm();
    if (dot >= 5 * cross) return 5;
    return std::max(0.05, dot / cross);  // cross > 0 here, or dot < 0 and the limit holds for -infinity too
}

template <int width>
void averaged(const Neighbours& near, std::vector<double>& values, int steps) {
    std::vector<double> next(values.size());
    for (int step = 0; step < steps; ++step) {
        parallel_for(near.rows(), [&](Index v) {
            std::array<double, width> sum;
            const double* own = values.data() + static_cast<std::size_t>(v) * width;
            for (int c = 0; c < width; ++c) sum[c] = own[c];
            for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) {
                const double* other = values.data() + static_cast<std::size_t>(near.vertex[k]) * width;
                for (int c = 0; c < width; ++c) sum[c] += other[c];
            }
            for (int c = 0; c < width; ++c) next[static_cast<std::size_t>(v) * width + c] = sum[c] / (1 + near.size(v));
        });
        values.swap(next);
    }
}

template <class Value>
Array<Value> taubin_steps(const Neighbours& near, Array<Value> p, int steps, double outwards) {
    Array<Value> next(p.size());
    for (int step = 0; step < 2 * steps; ++step) {
        const double factor = step % 2 == 0 ? 0.5 : outwards;
        parallel_for(near.rows(), [&](Index v) {
            Value sum = Value::Zero();
            for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) sum += p[near.vertex[k]];
            next[v] = near.size(v) > 0 ? Value(p[v] + factor * (sum / near.size(v) - p[v])) : p[v];
        });
        p.swap(next);
    }
    return p;
}

}  // namespace

Neighbours neighbours(const Faces& faces, const Incidence& at) {
    const Index count = at.size();
    Neighbours near;
    near.rim.assign(count, 0);
    near.offset.assign(count + 1, 0);
    parallel_chunks(count, 1024, [&](Index begin, Index end) {
        std::vector<Index> found;
        for (Index v = begin; v < end; ++v) {
            corners_around(faces, at, v, found);
            for (std::size_t k = 0; k < found.size();) {
                std::size_t next = k;
                while (next < found.size() && found[next] == found[k]) ++next;
                if (next - k != 2) near.rim[v] = 1;
                ++near.offset[v + 1];
                k = next;
            }
        }
    });
    for (Index v = 0; v < count; ++v) near.offset[v + 1] += near.offset[v];
    near.vertex.resize(near.offset.back());
    parallel_chunks(count, 1024, [&](Index begin, Index end) {
        std::vector<Index> found;
        for (Index v = begin; v < end; ++v) {
            corners_around(faces, at, v, found);
            std::unique_copy(found.begin(), found.end(), near.vertex.begin() + near.offset[v]);
        }
    });
    return near;
}

void two_rings(const Neighbours& near, Index v, std::vector<Index>& ring) {
    const auto row = [&](Index w) { return near.vertex.begin() + near.offset[w]; };
    ring.assign(row(v), row(v + 1));
    for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k)
        if (const Index w = near.vertex[k]; near.size(w) <= most_around) ring.insert(ring.end(), row(w), row(w + 1));
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    ring.erase(std::remove(ring.begin(), ring.end(), v), ring.end());
}

std::vector<double> cotangent_weights(const Faces& faces, const Incidence& at, const Neighbours& near,
                                      const Positions& p) {
    std::vector<double> weight(near.vertex.size(), 0);
    parallel_for(near.rows(), [&](Index v) {
        const auto row = near.vertex.begin() + near.offset[v], row_end = near.vertex.begin() + near.offset[v + 1];
        const auto of = [&](Index w) -> double& {
            return weight[std::lower_bound(row, row_end, w) - near.vertex.begin()];
        };
        for (const Index face : at[v]) {
            const Face& f = faces[face];
            const int corner = f[0] == v ? 0 : f[1] == v ? 1 : 2;
            const Index a = f[(corner + 1) % 3], b = f[(corner + 2) % 3];
            if (a == v || b == v || a == b) continue;
            of(a) += limited_cotangent(p[v] - p[b], p[a] - p[b]);
            of(b) += limited_cotangent(p[v] - p[a], p[b] - p[a]);
        }
        double sum = 0;
        for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) sum += weight[k];
        for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k)
            weight[k] = sum > 0 ? weight[k] / sum : 1.0 / near.size(v);
    });
    return weight;
}

Positions taubin(const Neighbours& near, Positions positions, int steps) {
    return taubin_steps(near, std::move(positions), steps, -0.53);
}

template <int count>
Array<Columns<count>> smoothed_fields(const Neighbours& near, Array<Columns<count>> fields, int steps) {
    return taubin_steps(near, std::move(fields), steps, -0.5);
}
template Array<Columns<1>> smoothed_fields<1>(const Neighbours&, Array<Columns<1>>, int);
template Array<Columns<2>> smoothed_fields<2>(const Neighbours&, Array<Columns<2>>, int);
template Array<Columns<3>> smoothed_fields<3>(const Neighbours&, Array<Columns<3>>, int);

Positions detail_of(const Neighbours& near, const Positions& p) {
    Positions out(p.size());
    parallel_for(near.rows(), [&](Index v) {
        Vec3 sum = Vec3::Zero();
        for (Index k = near.offset[v]; k < near.offset[v + 1]; ++k) sum += p[v] - p[near.vertex[k]];
        out[v] = near.size(v) > 0 ? Vec3(sum / near.size(v)) : Vec3(Vec3::Zero());
    });
    return out;
}

void average(const Neighbours& near, std::vector<double>& values, int width, int steps) {
    if (width == 1) return averaged<1>(near, values, steps);
    if (width == 2) return averaged<2>(near, values, steps);
    if (width == 3) return averaged<3>(near, values, steps);
    if (width == 6) return averaged<6>(near, values, steps);
    throw std::logic_error("average: there is no code for this width");
}

double gaussian(Index place, std::uint64_t seed) {
    const std::uint64_t a =
        random_bits(random_bits(seed * random_step) + static_cast<std::uint64_t>(place) * random_step);
    const double radius = std::sqrt(-2 * std::log(1 - unit_interval(a)));
    return radius * std::cos(2 * pi * unit_interval(random_bits(a + random_step)));
}

}  // namespace multires
