#include "normals/spikes.h"

#include "base/median.h"
#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace multires {
namespace {

/// A vertex is off by more than this many times the median of the offsets around, the second largest of the same sign
/// beside it, and its mean edge.
constexpr double above_all = 4, above_second = 2.5, above_edge = 0.03;
/// Passes: a spike may hide behind a larger one.
constexpr int passes = 3;
/// Share of spikes at first sight that makes noise impulsive: of Gaussian noise and of shapes without noise less than
/// 2 % look like spikes, of impulsive noise that meets one vertex in seven 5 to 16 %.
constexpr double impulsive = 0.03;
/// Length of the mean of the normals across, at least; where they differ more, there is no surface to be off from.
constexpr double agreement = 0.8;

struct Offset {
    double height = 0;  ///< signed
    Vec3 normal = Vec3::Zero();
    bool known = false;  ///< there are faces to compare with, and they agree
};

/// What the work on one vertex needs, kept from vertex to vertex.
struct Workspace {
    std::vector<double> heights;
    std::vector<Index> ring;
};

/// Which median of an even number of values: the mean of the two in the middle, which tells kinds of noise apart, or
/// that nearer to 0, which a spike beside moves less.
enum class Middle { mean, nearest };

/// @param values  at least one; reordered
double median(std::vector<double>& values, Middle middle) {
    const auto [lower, upper] = middle_values(values);
    if (middle == Middle::mean) return (lower + upper) / 2;
    return std::abs(lower) < std::abs(upper) ? lower : upper;
}

class Search {
public:
    Search(const Faces& faces, const Positions& p, const Incidence& at, Middle middle)
        : faces_(faces), p_(p), at_(at), middle_(middle), offset_(p.size()) {
        parallel_chunks(static_cast<Index>(p.size()), 1024, [&](Index begin, Index end) {
            Workspace space;
            for (Index v = begin; v < end; ++v) offset_[v] = offset_of(v, space);
        });
    }

    /// Where the vertex goes if it is a spike.
    std::optional<Vec3> mended(Index v, Workspace& space) const {
        const Offset& own = offset_[v];
        if (!own.known || !stands_out_of_ring(v, space)) return std::nullopt;
        if (!(std::abs(own.height) > above_all * median_around(v, space))) return std::nullopt;
        return p_[v] - own.height * own.normal;
    }

private:
    bool stands_out_of_ring(Index v, Workspace& space) const {
        const Offset& own = offset_[v];
        const double height = std::abs(own.height);
        space.ring.clear();
        for_ring(v, [&](Index w) { space.ring.push_back(w); });
        std::sort(space.ring.begin(), space.ring.end());
        space.ring.erase(std::unique(space.ring.begin(), space.ring.end()), space.ring.end());
        double edges = 0, first = 0, second = 0;
        for (const Index w : space.ring) {
            edges += (p_[w] - p_[v]).norm();
            if (offset_[w].height * own.height <= 0) continue;
            const double other = std::abs(offset_[w].height);
            second = std::max(second, std::min(first, other));
            first = std::max(first, other);
        }
        return height * static_cast<double>(space.ring.size()) > above_edge * edges && height > above_second * second;
    }

    /// Median of the offsets within two edges, where they are known.
    double median_around(Index v, Workspace& space) const {
        space.heights.clear();
        for_ring(v, [&](Index w) {
            for_ring(w, [&](Index u) {
                if (u != v && offset_[u].known) space.heights.push_back(std::abs(offset_[u].height));
            });
        });
        return space.heights.empty() ? std::numeric_limits<double>::infinity() : median(space.heights, middle_);
    }

    /// Calls with(neighbour), for most neighbours twice.
    template <class With>
    void for_ring(Index v, const With& with) const {
        for (const Index f : at_[v])
            for (const Index w : faces_[f])
                if (w != v) with(w);
    }

    Offset offset_of(Index v, Workspace& space) const {
        std::vector<double>& heights = space.heights;
        heights.clear();
        Offset offset;
        for (const Index f : at_[v])
            for_faces_across(faces_, at_, f, v, [&](const Face& g) {
                const Vec3& a = p_[g[0]];
                const Vec3 n = (p_[g[1]] - a).cross(p_[g[2]] - a);
                const double length = n.norm();
                if (!(length > 0)) return;
                heights.push_back(n.dot(p_[v] - a) / length);
                offset.normal += n / length;
            });
        const double length = offset.normal.norm();
        if (heights.size() < 4 || length < agreement * static_cast<double>(heights.size())) return {};
        offset.normal /= length;
        offset.height = median(heights, middle_);
        offset.known = true;
        return offset;
    }

    const Faces& faces_;
    const Positions& p_;
    const Incidence& at_;
    Middle middle_;
    std::vector<Offset> offset_;
};

}  // namespace

Positions without_spikes(const Faces& faces, const Positions& positions, const Incidence& at, Index& spikes) {
    const Index count = static_cast<Index>(positions.size());
    Positions p = positions, next = positions;
    std::vector<std::uint8_t> moved(positions.size(), 0);
    const auto pass = [&](Middle middle) {
        const Search search(faces, p, at, middle);
        parallel_chunks(count, 1024, [&](Index begin, Index end) {
            Workspace space;
            for (Index v = begin; v < end; ++v) {
                const auto place = search.mended(v, space);
                next[v] = place.value_or(p[v]);
                moved[v] |= place.has_value() ? 1 : 0;
            }
        });
    };
    const auto seen = [&] { return static_cast<Index>(std::count(moved.begin(), moved.end(), 1)); };

    spikes = 0;
    pass(Middle::mean);
    if (seen() < impulsive * count) return positions;
    std::fill(moved.begin(), moved.end(), std::uint8_t{0});
    for (int i = 0; i < passes; ++i) {
        pass(Middle::nearest);
        p.swap(next);
    }
    spikes = seen();
    return p;
}

}  // namespace multires
