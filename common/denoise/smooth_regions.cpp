#include "denoise/smooth_regions.h"

#include "base/decompositions.h"
#include "base/median.h"
#include "base/parallel.h"
#include "measure/vertex_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

namespace multires {
namespace {

constexpr double first_size = 16, growth = 1.5;  ///< vertices that a region has first, times the degree, and then
constexpr double most_open = 600;                ///< vertices: where no patch is certain with as many there is none
/// Vertices that floods may come to in vain, by those there are, at most so many: a flood comes to as many on large
/// meshes. The flattest faces are asked first: what is left then has hardly any patches.
constexpr double most_vain = 80, most_vain_for = 25000;
constexpr double least_cosine = 0.85;  ///< of the normals of a face, denoised, and its patch
constexpr double off = 3;              ///< deviations that the mean square of a region may be off
/// Share by which that of all regions together may be larger, and deviations beside it: shapes that only resemble
/// patches have regions that pass one by one.
constexpr double excess = 0.06, surely = 2;
constexpr double least_share = 0.1;  ///< of the faces in regions: fewer resemble patches by chance
constexpr double certain = 0.5;  ///< terms of higher degree may turn a patch by such a share of what it turns normals
constexpr int rounds = 16;       ///< of projections
constexpr std::size_t most_at_once = 8;  ///< seeds that grow at the same time

struct Region {
    Patch patch;
    std::vector<Index> faces, vertices;
    double square = 0, freedom = 0;  ///< of the residuals, in deviations of the errors; what they would be
};

SmoothRegions none(std::size_t faces) { return {std::vector<Index>(faces, -1), {}}; }

enum class Verdict { wrong, open, right };

Vec3 unit_normal(const Face& f, const Positions& p) {
    const Vec3 n = area_vector(f, p);
    return n.norm() > 0 ? Vec3(n.normalized()) : Vec3(Vec3::Zero());
}

/// What regions are grown on.
struct Ground {
    const Faces& faces;
    const Incidence& at;
    const Positions& places;  ///< as given
    const PlaceErrors& errors;
    Array<Vec3> normal;             ///< #F, of the denoised surface; 0 where nothing is asked
    Array<Vec3> middle;             ///< #F, of the places
    std::vector<Index> first_next;  ///< #F+1
    std::vector<Index> next;        ///< faces with a common edge, in compressed rows
    std::vector<Index> region;      ///< #F: that it is in already; -1: none

    Ground(const Faces& faces_, const Incidence& at_, const std::vector<std::uint8_t>& asked, const Positions& given,
           const PlaceErrors& errors_, const Positions& denoised)
        : faces(faces_), at(at_), places(given), errors(errors_), normal(faces.size()), middle(faces.size()),
          first_next(faces.size() + 1, 0), region(faces.size(), -1) {
        const Index count = static_cast<Index>(faces.size());
        parallel_for(count, [&](Index f) {
            const Face& v = faces[f];
            normal[f] = asked[f] != 0 ? unit_normal(v, denoised) : Vec3(Vec3::Zero());
            middle[f] = (places[v[0]] + places[v[1]] + places[v[2]]) / 3;
            for_faces_beside(f, [&](Index) { ++first_next[f + 1]; });
        });
        std::partial_sum(first_next.begin(), first_next.end(), first_next.begin());
        next.resize(first_next.back());
        parallel_for(count, [&](Index f) {
            Index k = first_next[f];
            for_faces_beside(f, [&](Index g) { next[k++] = g; });
        });
    }

    template <class With>
    void for_faces_near(Index f, const With& with) const {
        for (const Index v : faces[f])
            for (const Index g : at[v]) with(g);
    }
    Vec3 normal_around(Index f) const {
        Vec3 sum = Vec3::Zero();
        for_faces_near(f, [&](Index g) { sum += normal[g]; });
        return sum;
    }
    std::vector<Index> flattest_first() const {
        std::vector<double> bend(faces.size());
        parallel_for(static_cast<Index>(faces.size()), [&](Index f) {
            double count = 0;
            for_faces_near(f, [&](Index) { count += 1; });
            bend[f] = 1 - normal_around(f).norm() / count;
        });
        std::vector<Index> order(faces.size());
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](Index f, Index g) { return bend[f] < bend[g]; });
        return order;
    }

private:
    template <class With>
    void for_faces_beside(Index f, const With& with) const {
        for (int k = 0; k < 3; ++k)
            for (const Index g : at[faces[f][k]])
                if (g != f && std::count(faces[g].begin(), faces[g].end(), faces[f][(k + 1) % 3]) > 0) with(g);
    }
};

/// Grows one region after the other.
class Grower {
public:
    explicit Grower(const Ground& ground)
        : ground_(ground), faces_(ground.faces), q_(ground.places), errors_(ground.errors), normal_(ground.normal),
          middle_(ground.middle), face_mark_(faces_.size(), -1), vertex_mark_(q_.size(), -1),
          asked_mark_(q_.size(), -1), met_(q_.size()) {}

    std::optional<Region> grown(Index seed) {
        const Vec3 normal = ground_.normal_around(seed).normalized(), x = normal.unitOrthogonal();
        const Patch start{middle_[seed], x, normal.cross(x), normal};
        double turns = 0, bent_turns = 0;
        std::optional<Region> flat = grown(seed, start, 1, turns), bent = grown(seed, start, 2, bent_turns);
        return bent && (!flat || bent_turns < turns) ? bent : flat;
    }
    /// Vertices that floods have come to so far.
    double flooded() const { return flooded_; }

private:
    bool meets(const Patch& patch, Index v) const {
        return errors_.allows(patch.height(q_[v]), patch.gradient(q_[v]), v);
    }
    bool fits(const Patch& patch, Index f) {
        if (ground_.region[f] >= 0) return false;
        const Vec3 gradient = patch.gradient(middle_[f]);
        if (!(normal_[f].dot(gradient) > least_cosine * gradient.norm())) return false;
        return std::all_of(faces_[f].begin(), faces_[f].end(), [&](Index v) {
            if (asked_mark_[v] != mark_) asked_mark_[v] = mark_, met_[v] = meets(patch, v);
            return met_[v] != 0;
        });
    }

    /// Faces around the seed that fit, of so many vertices.
    Region flooded(Index seed, const Patch& patch, Index most) {
        Region r;
        r.patch = patch;
        ++mark_;
        const auto add = [&](Index f) {
            face_mark_[f] = mark_;
            if (!fits(patch, f)) return;
            r.faces.push_back(f);
            for (const Index v : faces_[f])
                if (vertex_mark_[v] != mark_) vertex_mark_[v] = mark_, r.vertices.push_back(v);
        };
        add(seed);
        for (std::size_t i = 0; i < r.faces.size() && static_cast<Index>(r.vertices.size()) < most; ++i) {
            const Index f = r.faces[i];
            for (Index k = ground_.first_next[f]; k < ground_.first_next[f + 1]; ++k)
                if (face_mark_[ground_.next[k]] != mark_) add(ground_.next[k]);
        }
        flooded_ += static_cast<double>(r.vertices.size());
        return r;
    }

    Patch plane(const Region& r) const {
        Vec3 center = Vec3::Zero();
        double sum = 0;
        for (const Index v : r.vertices) center += errors_.weight(v) * q_[v], sum += errors_.weight(v);
        center /= sum;
        Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
        for (const Index v : r.vertices) m += errors_.weight(v) * (q_[v] - center) * (q_[v] - center).transpose();
        Vec3 n = principal_axes(m).vectors.col(0);
        if (n.dot(r.patch.z) < 0) n = -n;
        const Vec3 x = n.unitOrthogonal();
        return {center, x, n.cross(x), n};
    }
    /// The best polynomial over a plane, and a plane that has its tangent in the middle.
    Patch curved(const Region& r) const {
        const Patch p = plane(r);
        const PatchFit fit = fit_over(p, r.vertices, q_, errors_, 2);
        const auto& c = fit.coefficient;
        Patch out;
        out.center = p.center + c[0] * p.z;
        out.z = (p.z - (c[1] * p.x + c[2] * p.y) / fit.scale).normalized();
        out.x = (p.x + c[1] / fit.scale * p.z).normalized();
        out.y = out.z.cross(out.x);
        for (int i = 0; i < 3; ++i) out.bend[i] = c[3 + i] / (fit.scale * fit.scale);
        return out;
    }

    /// Whether the vertices of a region tell that its patch is there. Creases show in terms of even degree.
    /// @param[out] turns  how far the patch may be turned by what it has not
    Verdict verdict(Region& r, int degree, double& turns) const {
        const double n = static_cast<double>(r.vertices.size());
        if (n < 1.5 * terms_up_to(2 * degree)) return Verdict::open;
        r.square = 0;
        for (const Index v : r.vertices) {
            const double off_by = r.patch.height(q_[v]) / (r.patch.gradient(q_[v]).norm() * errors_.deviation(v));
            r.square += off_by * off_by;
        }
        r.freedom = n - terms_up_to(degree);
        const double more_than_noise = (r.square - r.freedom) / (errors_.spread() * std::sqrt(n));
        if (more_than_noise > off) return Verdict::wrong;
        if (errors_.rounded() && more_than_noise < -off) return Verdict::open;  // a terrace
        const PatchFit more = fit_over(r.patch, r.vertices, q_, errors_, 2 * degree);
        std::vector<double> angle;
        for (const Index f : r.faces) angle.push_back((normal_[f] - r.patch.gradient(middle_[f]).normalized()).norm());
        const double most = certain * lower_quantile(angle, 0.5), noise = more.tilt_by_noise;
        turns = std::hypot(more.tilt, noise);
        if (turns < most) return Verdict::right;
        return more.tilt > most + 2 * noise ? Verdict::wrong : Verdict::open;
    }

    /// The largest region of one degree around a face.
    std::optional<Region> grown(Index seed, Patch patch, int degree, double& turns) {
        std::optional<Region> best;
        std::size_t last = 0;
        for (double most = degree * first_size;; most = std::floor(most * growth)) {
            Region r = flooded(seed, patch, static_cast<Index>(most));
            for (int again = 0; again < 2 && r.vertices.size() > 8; ++again)
                r = flooded(seed, degree == 1 ? plane(r) : curved(r), static_cast<Index>(most));
            double now = 0;
            const Verdict is = verdict(r, degree, now);
            const double size = static_cast<double>(r.vertices.size());
            const bool ends = size < most || r.vertices.size() <= last;
            last = r.vertices.size();
            patch = r.patch;
            if (is == Verdict::right) {
                best = std::move(r);
                turns = now;
            }
            const bool uncertain = is == Verdict::open && (best || most > most_open);
            if (ends || uncertain || is == Verdict::wrong) return best;
        }
    }

    const Ground& ground_;
    const Faces& faces_;
    const Positions& q_;
    const PlaceErrors& errors_;
    const Array<Vec3>&normal_, &middle_;
    std::vector<Index> face_mark_, vertex_mark_;  ///< the last flood that came there
    std::vector<Index> asked_mark_;               ///< and that asked whether the patch may be met,
    std::vector<std::uint8_t> met_;               ///< what it was told
    double flooded_ = 0;
    Index mark_ = 0;
};

/// Regions from the flattest seeds on. Most seeds grow none, which changes nothing for the next ones: so the next few
/// grow at the same time, and what they grew counts unless there is a new region by then.
class Growth {
public:
    explicit Growth(Ground& ground) : ground_(ground), tried_(ground.faces.size(), 0) {}

    SmoothRegions all() {
        SmoothRegions out = none(ground_.faces.size());
        double square = 0, freedom = 0;
        double left = most_vain * std::min(most_vain_for, static_cast<double>(ground_.places.size()));
        const std::vector<Index> order = ground_.flattest_first();
        for (std::size_t place = 0; place < order.size(); ++place) {
            if (!open(order[place])) continue;
            if (!(left > 0)) break;
            const Grown& grown = grown_at(order, place);
            if (!grown.region) {
                left -= grown.flooded;
                ground_.for_faces_near(order[place],
                                       [&](Index g) { ground_.for_faces_near(g, [&](Index h) { tried_[h] = 1; }); });
                continue;
            }
            const Region& region = *grown.region;
            square += region.square;
            freedom += region.freedom;
            if (square > (1 + excess) * freedom + surely * ground_.errors.spread() * std::sqrt(freedom))
                return none(ground_.faces.size());
            for (const Index g : region.faces) ground_.region[g] = static_cast<Index>(out.patch.size());
            out.patch.push_back(region.patch);
            ahead_.clear();
            at_once_ = 1;
        }
        const auto in_regions =
            std::count_if(ground_.region.begin(), ground_.region.end(), [](Index r) { return r >= 0; });
        const auto asked =
            std::count_if(ground_.normal.begin(), ground_.normal.end(), [](const Vec3& n) { return !n.isZero(); });
        if (static_cast<double>(in_regions) < least_share * static_cast<double>(asked))
            return none(ground_.faces.size());
        out.of_face = ground_.region;
        return out;
    }

private:
    struct Grown {
        Index seed;
        std::optional<Region> region;
        double flooded = 0;  ///< vertices that floods came to
    };

    bool open(Index f) const { return ground_.region[f] < 0 && !tried_[f] && !ground_.normal[f].isZero(); }
    const Grown& grown_at(const std::vector<Index>& order, std::size_t place) {
        for (const Grown& grown : ahead_)
            if (grown.seed == order[place]) return grown;
        ahead_.clear();
        for (; place < order.size() && ahead_.size() < at_once_; ++place)
            if (open(order[place])) ahead_.push_back({order[place], {}, 0});
        while (growers_.size() < ahead_.size()) growers_.emplace_back(ground_);
        parallel_for(
            static_cast<Index>(ahead_.size()),
            [&](Index i) {
                const double before = growers_[i].flooded();
                ahead_[i].region = growers_[i].grown(ahead_[i].seed);
                ahead_[i].flooded = growers_[i].flooded() - before;
            },
            1);
        at_once_ = std::min(2 * at_once_, thread_count() > 1 ? most_at_once : std::size_t{1});
        return ahead_.front();
    }

    Ground& ground_;
    std::vector<std::uint8_t> tried_;  ///< #F: near to seeds that grew none
    std::vector<Grower> growers_;
    std::vector<Grown> ahead_;  ///< from here and the next seeds
    std::size_t at_once_ = 1;
};

}  // namespace

SmoothRegions smooth_regions(const Faces& faces, const Incidence& at, const std::vector<std::uint8_t>& asked,
                             const Positions& given, const PlaceErrors& errors, const Positions& positions) {
    if (std::find(asked.begin(), asked.end(), 1) == asked.end()) return none(faces.size());
    Ground ground(faces, at, asked, given, errors, positions);
    return Growth(ground).all();
}

void move_into(const SmoothRegions& regions, const Incidence& at, const EvenPlaces& even, const Positions& given,
               const PlaceErrors& errors, double share, Positions& positions) {
    parallel_for(static_cast<Index>(positions.size()), [&](Index v) {
        std::vector<Index> around;
        for (const Index f : at[v])
            if (regions.of_face[f] >= 0) around.push_back(regions.of_face[f]);
        // Where regions end other than at a crease there must be no step.
        const double part =
            errors.rounded() ? 1 : static_cast<double>(around.size()) / static_cast<double>(at[v].size());
        std::sort(around.begin(), around.end());
        around.erase(std::unique(around.begin(), around.end()), around.end());
        if (around.empty()) return;
        Vec3 most = Vec3::Constant(errors.step() / 2);
        for (int axis = 0; axis < 3 && !even.axes.empty(); ++axis)
            if (even.axes[v] >> axis & 1U) most[axis] = 0;
        Vec3 p = positions[v];
        for (int round = 0; round < rounds; ++round) {
            for (const Index r : around) {
                const Vec3 gradient = regions.patch[r].gradient(p);
                p -= regions.patch[r].height(p) / gradient.squaredNorm() * gradient;
            }
            if (errors.rounded()) {
                p = p.cwiseMax(given[v] - most).cwiseMin(given[v] + most);
            } else {
                const double length = (p - given[v]).norm(), longest = errors.farthest(v);
                if (length > longest) p = given[v] + longest / length * (p - given[v]);
            }
        }
        positions[v] += share * part * (p - positions[v]);
    });
}

}  // namespace multires
