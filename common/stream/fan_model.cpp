#include "stream/fan_model.h"

#include "base/error.h"
#include "stream/geometry.h"

#include <algorithm>

namespace multires::stream {
namespace {

constexpr int buckets = 24, most_valence = 11;

int clamp(int x, int most) { return std::min(std::max(x, 0), most); }

/// x / n: the same number without a division, which takes most of the time, if n is a power of two.
double over(double x, Index n) {
    if (n == 1) return x;
    if (n == 2) return x * 0.5;
    return n == 4 ? x * 0.25 : x / n;
}

/// log2 of a ratio of positive numbers in steps of a third of an octave.
int ratio_bucket(double a, double b) { return b > 0 ? clamp(octave_steps(a / b, 3) + buckets / 2, buckets - 1) : 0; }

/// How far the middle of a new vertex's ring is from the parent, relative to how far the ring extends: vertices go to
/// near parents.
/// @param sum      of the rays from the parent to the others in the ring
/// @param squares  sum of their squares
inline int nearness(const Vec3& sum, double squares, Index count) {
    const double middle = dot(sum, sum);
    return ratio_bucket(middle, count * squares - middle);
}

}  // namespace

void StarShape::take(const StarMesh& mesh, Index u, Index batch) {
    mesh.star(u, star);
    const Index d = star.faces();
    taken.resize(d);
    faces_taken = 0;
    for (Index i = 0; i < d; ++i) {
        taken[i] = mesh.mark(StarMesh::face_of(star.leaving[i])) == batch;
        faces_taken += taken[i];
    }
}

void StarShape::measure(const StarMesh& mesh, Index u) {
    const Index d = star.faces();
    spokes.resize(d + 1);
    Spoke* const s = spokes.data();
    s[0].area_to = s[0].cotangent = s[0].bend = s[d].bend = 0;
    const Vec3& centre = mesh.point(u);
    Vec3 b = mesh.point(star.spoke[0]) - centre, before(0, 0, 0), first(0, 0, 0);
    const auto tell = [&](Index i) {
        s[i].ray = b, s[i].square = dot(b, b), s[i].length = std::sqrt(s[i].square);
        s[i].valence = clamp(mesh.valence(star.spoke[i]), most_valence);
    };
    for (Index i = 0; i < d; ++i) {
        tell(i);
        const Vec3 a = b;
        b = mesh.point(star.spoke[i + 1]) - centre;
        Vec3 normal = cross(a, b);
        const double twice = stream::length(normal);
        s[i + 1].cotangent = 0;
        if (twice > 0) {
            normal /= twice;
            s[i].cotangent += dot(b, b - a) / twice;
            s[i + 1].cotangent += dot(a, a - b) / twice;
        }
        s[i + 1].area_to = s[i].area_to + twice / 2;
        if (i > 0)
            s[i].bend = 1 - dot(before, normal);
        else
            first = normal;
        before = normal;
    }
    tell(d);
    if (star.closed) {
        s[0].cotangent = s[d].cotangent = s[0].cotangent + s[d].cotangent;
        s[0].bend = s[d].bend = 1 - dot(before, first);
    }
    total = s[d].area_to;
}

FanModel::FanModel(bool first_models) : first_models_(first_models), is_it_({64, 64 * 16, 16 * 16, 16 * 64}, 16) {
    weights_.assign(features * 1024, 0);
    squares_.assign(weights_.size(), 1);
}

void FanModel::rank(const StarShape& shape) {
    const Index d = shape.star.faces();
    candidates_.resize(std::max(candidates_.size(), (static_cast<std::size_t>(d) + 2) * (most_faces + 1)));
    score_.resize(candidates_.size());
    count_ = 0;
    for (Index i = 0; i < d; ++i) {
        const Index most = std::min<Index>(most_faces, shape.star.closed ? d - 1 : d - i);
        Inner inner;
        for (Index m = 1; m <= most; ++m) {
            const Index face = i + m - 1 < d ? i + m - 1 : i + m - 1 - d;
            if (shape.taken[face]) break;
            if (m > 1) inner.add(shape.spokes[face]);
            add(shape, {Fan::inside, i, m}, inner);
        }
    }
    if (!shape.star.closed)
        for (Index m = 0; m <= std::min<Index>(most_faces, d); ++m) {
            for (const Fan& fan : {Fan{Fan::first, 0, m}, Fan{Fan::last, d - m, m}}) {
                if (m > 0 && shape.taken[fan.kind == Fan::first ? m - 1 : d - m]) continue;
                Inner inner;
                for (Index i = fan.start + 1; i < fan.start + m; ++i) inner.add(shape.spokes[i]);
                add(shape, fan, inner);
            }
        }
    evidence_ = -20;
    for (std::size_t i = 0; i < count_; ++i) evidence_ = std::max(evidence_, score_[i]);
    if (first_models_) find_shares();
}

/// Up to their sum, that is: the quotients are only wanted if one of the fans is.
void FanModel::find_shares() {
    const std::size_t count = count_;
    double most = -1e9;
    for (std::size_t i = 0; i < count; ++i) most = std::max(most, score_[i]);
    share_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double power = exponential(score_[i] - most);
        share_[i] = score_[i] > most - 14 ? power : 0;
    }
    sum_ = 0;
    for (const double x : share_) sum_ += x;
    if (first_models_ && count > 0) evidence_ = most + 0.6931471805599453 * logarithm(sum_);
}

void FanModel::add(const StarShape& s, const Fan& fan, const Inner& inner) {
    const Index d = s.star.faces(), m = fan.faces, from = fan.start, past = from + m - d;
    // A closed star's last spoke is its first.
    const StarShape::Spoke &a = s.spokes[from], &b = s.spokes[past > 0 ? past : from + m];
    const double area = past <= 0 ? b.area_to - a.area_to : s.total - a.area_to + b.area_to;
    const double wings = (a.length + b.length) / 2;
    const double outer = (a.cotangent + b.cotangent) / 2;
    const Index edges = m - 1;
    const int kind = fan.kind == Fan::inside ? 0 : 1, size = m + 10 * kind;  // below 20
    const int rest = clamp(d - m + 2, 15);
    Candidate& c = candidates_[count_];
    c.fan = fan;
    const auto cot_bucket = [](double x) {
        x = (x + 2) * 4;
        x = x > 0 ? x : 0;
        return static_cast<int>(x < 20 ? x : 20);
    };
    const std::array<int, features> value = {
        size * 16 + rest,
        std::min(a.valence, b.valence) * (most_valence + 1) + std::max(a.valence, b.valence) + 144 * (m > 4) +
            288 * kind,
        size * buckets + (m > 1 ? ratio_bucket(over(inner.length, edges), wings) : 0),
        size * buckets + ratio_bucket(area * d, s.total * m),
        size * 21 + (m > 1 ? cot_bucket(over(inner.cotangent, edges)) : 0),
        size * 21 + cot_bucket(outer),
        size * buckets + (m > 1 ? clamp(octave_steps(over(inner.bend, edges), 2) + 20, buckets - 1) : 0),
        first_models_
            ? size * 16 + clamp(d, 15)
            : size * buckets + nearness(inner.sum + (a.ray + b.ray), inner.squares + (a.square + b.square), m + 2)};
    const double* const weights = weights_.data();
    double score = 0;
    for (int i = 0; i < features; ++i) {
        c.weight[i] = i * 1024 + value[i];
        score += weights[c.weight[i]];
    }
    score_[count_++] = score;
}

Fan FanModel::code(BitCoder& coder, const StarShape& shape, const Fan& fan) {
    std::size_t wanted = count_;
    if (!coder.reads())
        for (std::size_t i = 0; i < count_; ++i) {
            const Fan& c = candidates_[i].fan;
            if (c.kind == fan.kind && c.faces == fan.faces && (c.kind != Fan::inside || c.start == fan.start))
                wanted = i;
        }
    if (!first_models_) find_shares();
    for (double& share : share_) share /= sum_;
    const std::size_t chosen = code_rank(coder, wanted);
    if (chosen == count_) return code_plainly(coder, shape, fan);
    learn(chosen);
    return candidates_[chosen].fan;
}

std::size_t FanModel::code_rank(BitCoder& coder, std::size_t wanted) {
    const std::size_t count = count_;
    unranked_ = share_;
    // Few ranks are looked at: the next is looked for when it is wanted. Of equal shares the first comes first.
    const auto take_largest = [&] {
        double most = -1;
        std::size_t at = 0;
        for (std::size_t i = 0; i < count; ++i) {
            at = unranked_[i] > most ? i : at;
            most = unranked_[i] > most ? unranked_[i] : most;
        }
        unranked_[at] = -1;
        return at;
    };
    double left = 1;
    std::size_t one = count > 0 ? take_largest() : 0;
    for (std::size_t rank = 0; rank < count; ++rank) {
        const std::size_t other = rank + 1 < count ? take_largest() : 0;
        const double chance = left > 1e-6 ? std::min(share_[one] / left, 1.0) : 0.5;
        const int share = clamp(static_cast<int>(chance * 63), 63), place = clamp(static_cast<int>(rank), 15);
        const int next = rank + 1 < count && left > 1e-6 ? clamp(static_cast<int>(share_[other] / left * 15), 15) : 0;
        const int faces = std::min<int>(candidates_[one].fan.faces, 15);
        if (is_it_.code(coder, one == wanted, {share, share * 16 + place, place * 16 + faces, next * 64 + share},
                        place))
            return one;
        left -= share_[one];
        one = other;
    }
    return count;
}

void FanModel::learn(std::size_t chosen) {
    for (std::size_t i = 0; i < count_; ++i) {
        const Candidate& c = candidates_[i];
        const double step = (i == chosen ? 1 : 0) - share_[i];
        if (step > -1e-3 && step < 1e-3) continue;
        std::array<double, features> by;
        for (int k = 0; k < features; ++k) by[k] = squares_[c.weight[k]] += step * step;
        for (double& x : by) x = 0.35 * step / std::sqrt(x);
        for (int k = 0; k < features; ++k) weights_[c.weight[k]] += by[k];
    }
}

Fan FanModel::code_plainly(BitCoder& coder, const StarShape& shape, const Fan& fan) {
    Fan out;
    out.kind = static_cast<Fan::Kind>(coder.code_plain(fan.kind, 2) % 3);
    out.start = static_cast<Index>(coder.code_plain(fan.start, 30));
    out.faces = static_cast<Index>(coder.code_plain(fan.faces, 30));
    require(StarMesh::allows(shape.star, out), "the stream is damaged: it splits what is not there");
    for (Index i = 0; i < out.faces; ++i) {
        const Index from = out.kind == Fan::last    ? shape.star.faces() - out.faces
                           : out.kind == Fan::first ? 0
                                                    : out.start;
        require(!shape.taken[(from + i) % shape.star.faces()], "the stream is damaged: it splits what is not there");
    }
    return out;
}

}  // namespace multires::stream
