#include "denoise/outliers.h"

#include "base/median.h"
#include "base/parallel.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace multires {
namespace {

constexpr double long_edge = 2;    ///< second shortest edge over the median outer edge of its star: the vertex is far
constexpr double agreement = 0.7;  ///< length of the mean of the normals across, at least
/// Least cosine between that and the star's normals: with the vertex in place at least, where it is at most.
constexpr double fits = 0.3, steep = 0.5;
constexpr Index most_edges = 10;  ///< of an outlier: measured points have no more, tips of cones that were drawn do
constexpr double least_off = 2;
constexpr double above_most = 2.25, most = 0.995;  ///< so many times as far as this share of the vertices
constexpr double single = 0.03;                    ///< share of outliers, at most

struct Seen {
    double off = -1;     ///< see without_outliers(); negative: not known
    bool apart = false;  ///< the surface is sound without it, and is not with it
    Vec3 place = Vec3::Zero();
};

class Stars {
public:
    Stars(const Faces& faces, const Positions& p, const Incidence& at, const Neighbours& near)
        : faces_(faces), p_(p), at_(at), near_(near), far_(p.size()) {
        parallel_chunks(near.rows(), 1024, [&](Index begin, Index end) {
            for (Index v = begin; v < end; ++v) far_[v] = is_far(v);
        });
    }

    Seen seen(Index v) const {
        Seen seen;
        if (near_.rim[v]) return seen;
        const std::vector<Vec3> ring = sound_ring(v);
        if (ring.size() < 3) return seen;
        Vec3 center = Vec3::Zero();
        for (const Vec3& w : ring) center += w / static_cast<double>(ring.size());
        std::vector<double> radius;
        radius.reserve(ring.size());
        for (const Vec3& w : ring) radius.push_back((w - center).norm());
        Vec3 normal = Vec3::Zero();
        double height = 0, edges = 0, planes = 0;
        for_planes_across(v, [&](const Face& g, const Vec3& n) {
            normal += n;
            height += n.dot(center - p_[g[0]]);
            for (int k = 0; k < 3; ++k) edges += (p_[g[k]] - p_[g[(k + 1) % 3]]).norm() / 3;
            ++planes;
        });
        if (planes < 4) return seen;
        const double agree = normal.norm() / planes;
        normal.normalize();
        seen.place = center - height / planes / 2 * normal;
        seen.off = (p_[v] - seen.place).norm() / std::max(upper_median(radius), edges / planes);
        seen.apart = near_.size(v) <= most_edges && agree > agreement && steepest(v, seen.place, normal) > fits &&
                     steepest(v, p_[v], normal) < steep;
        return seen;
    }

private:
    bool is_far(Index v) const {
        if (near_.size(v) < 3) return false;
        std::vector<double> edges, outer;
        for (Index i = near_.offset[v]; i < near_.offset[v + 1]; ++i)
            edges.push_back((p_[near_.vertex[i]] - p_[v]).norm());
        for (const Index f : at_[v]) {
            const auto [a, b] = outer_edge(f, v);
            outer.push_back((p_[a] - p_[b]).norm());
        }
        std::nth_element(edges.begin(), edges.begin() + 1, edges.end());
        return edges[1] > long_edge * upper_median(outer);
    }

    std::pair<Index, Index> outer_edge(Index f, Index v) const {
        const Face& g = faces_[f];
        return g[0] == v ? std::pair(g[1], g[2]) : g[1] == v ? std::pair(g[2], g[0]) : std::pair(g[0], g[1]);
    }

    std::vector<Vec3> sound_ring(Index v) const {
        std::vector<Vec3> ring;
        for (Index i = near_.offset[v]; i < near_.offset[v + 1]; ++i)
            if (!far_[near_.vertex[i]]) ring.push_back(p_[near_.vertex[i]]);
        return ring;
    }

    /// Calls with(face, normal) for the faces across the star's outer edges, without far vertices.
    template <class With>
    void for_planes_across(Index v, const With& with) const {
        for (const Index f : at_[v])
            for_faces_across(faces_, at_, f, v, [&](const Face& g) {
                if (std::any_of(g.begin(), g.end(), [&](Index w) { return far_[w]; })) return;
                const Vec3 n = (p_[g[1]] - p_[g[0]]).cross(p_[g[2]] - p_[g[0]]);
                const double length = n.norm();
                if (length > 0) with(g, n / length);
            });
    }

    /// Least cosine between the normals of the star with v at a place and this normal.
    double steepest(Index v, const Vec3& place, const Vec3& normal) const {
        double least = 1;
        for (const Index f : at_[v]) {
            const auto [a, b] = outer_edge(f, v);
            if (far_[a] || far_[b]) continue;
            const Vec3 n = (p_[a] - place).cross(p_[b] - place);
            const double length = n.norm();
            least = std::min(least, length > 0 ? n.dot(normal) / length : 0);
        }
        return least;
    }

    const Faces& faces_;
    const Positions& p_;
    const Incidence& at_;
    const Neighbours& near_;
    std::vector<std::uint8_t> far_;
};

/// How far is too far, by all but candidates and their neighbours.
double limit(const std::vector<Seen>& seen, const std::vector<std::uint8_t>& candidate, const Neighbours& near) {
    std::vector<double> off;
    for (Index v = 0; v < near.rows(); ++v) {
        const auto is_candidate = [&](Index w) { return candidate[w] != 0; };
        const auto* const ring = near.vertex.data();
        if (seen[v].off < 0 || is_candidate(v) ||
            std::any_of(ring + near.offset[v], ring + near.offset[v + 1], is_candidate))
            continue;
        off.push_back(seen[v].off);
    }
    if (off.empty()) return std::numeric_limits<double>::infinity();
    return above_most * lower_quantile(off, most);
}

}  // namespace

Positions without_outliers(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                           std::vector<std::uint8_t>& outliers) {
    const Stars stars(faces, positions, at, near);
    std::vector<Seen> seen(positions.size());
    parallel_chunks(near.rows(), 1024, [&](Index begin, Index end) {
        for (Index v = begin; v < end; ++v) seen[v] = stars.seen(v);
    });
    outliers.resize(positions.size());
    for (std::size_t v = 0; v < seen.size(); ++v) outliers[v] = seen[v].apart && seen[v].off > least_off;
    const double least = limit(seen, outliers, near);
    for (std::size_t v = 0; v < seen.size(); ++v) outliers[v] = outliers[v] && seen[v].off > least;
    const auto count = static_cast<double>(std::count(outliers.begin(), outliers.end(), 1));
    if (count > single * static_cast<double>(positions.size()))
        std::fill(outliers.begin(), outliers.end(), std::uint8_t{0});
    Positions after = positions;
    for (std::size_t v = 0; v < after.size(); ++v)
        if (outliers[v]) after[v] = seen[v].place;
    return after;
}

}  // namespace multires
