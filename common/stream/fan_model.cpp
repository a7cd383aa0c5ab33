#include "stream/fan_model.h"

#include "base/error.h"
#include "stream/geometry.h"

#include <algorithm>
#include <numeric>

namespace multires::stream {
namespace {

constexpr int buckets = 24;

int clamp(int x, int most) { return std::min(std::max(x, 0), most); }

/// log2 of a ratio of positive numbers in steps of a third of an octave.
int ratio_bucket(double a, double b) { return b > 0 ? clamp(octave_steps(a / b, 3) + buckets / 2, buckets - 1) : 0; }

}  // namespace

void StarShape::take(const StarMesh& mesh, const Positions& p, Index u, const std::vector<Index>& batch_of,
                     Index batch) {
    mesh.star(u, star);
    const Index d = star.faces();
    taken.resize(d), area.resize(d), area_to.resize(d + 1);
    valence.resize(d + 1), length.resize(d + 1), cotangent.assign(d + 1, 0), bend.assign(d + 1, 0);
    normal.resize(d);
    for (Index i = 0; i <= d; ++i) {
        valence[i] = mesh.valence(star.spoke[i]);
        length[i] = stream::length(p[star.spoke[i]] - p[u]);
    }
    area_to[0] = 0;
    for (Index i = 0; i < d; ++i) {
        taken[i] = batch_of[star.leaving[i] / 3] == batch;
        const Vec3 a = p[star.spoke[i]] - p[u], b = p[star.spoke[i + 1]] - p[u];
        normal[i] = cross(a, b);
        const double twice = stream::length(normal[i]);
        if (twice > 0) {
            normal[i] /= twice;
            cotangent[i] += dot(b, b - a) / twice;
            cotangent[i + 1] += dot(a, a - b) / twice;
        }
        area[i] = twice / 2;
        area_to[i + 1] = area_to[i] + area[i];
    }
    for (Index i = 1; i < d; ++i) bend[i] = 1 - dot(normal[i - 1], normal[i]);
    if (star.closed) {
        cotangent[0] = cotangent[d] = cotangent[0] + cotangent[d];
        bend[0] = bend[d] = 1 - dot(normal[d - 1], normal[0]);
    }
    total = area_to[d];
}

FanModel::FanModel() : is_it_({64, 64 * 16, 16 * 16, 16 * 64}, 16) {
    weights_.assign(features * 1024, 0);
    squares_.assign(weights_.size(), 1);
}

void FanModel::rank(const StarShape& shape) {
    candidates_.clear();
    const Index d = shape.star.faces();
    for (Index i = 0; i < d; ++i) {
        const Index most = std::min<Index>(most_faces, shape.star.closed ? d - 1 : d - i);
        for (Index m = 1; m <= most && !shape.taken[(i + m - 1) % d]; ++m) add(shape, {Fan::inside, i, m});
    }
    if (!shape.star.closed)
        for (Index m = 0; m <= std::min<Index>(most_faces, d); ++m) {
            if (m == 0 || !shape.taken[m - 1]) add(shape, {Fan::first, 0, m});
            if (m == 0 || !shape.taken[d - m]) add(shape, {Fan::last, d - m, m});
        }
    double most = -1e9, sum = 0;
    for (const Candidate& c : candidates_) most = std::max(most, c.score);
    for (Candidate& c : candidates_) sum += c.share = c.score > most - 14 ? exponential(c.score - most) : 0;
    for (Candidate& c : candidates_) c.share /= sum;
    evidence_ = candidates_.empty() ? -20 : most + 0.6931471805599453 * logarithm(sum);
}

void FanModel::add(const StarShape& s, const Fan& fan) {
    const Index d = s.star.faces(), m = fan.faces, from = fan.start, to = from + m;
    const auto at = [&](Index i) { return i > d ? i - d : i; };
    const auto spoke = [&](Index i) { return s.star.closed ? i % d : i; };
    double area = 0, inner = 0, cotangent = 0, bend = 0;
    area = to <= d ? s.area_to[to] - s.area_to[from] : s.total - s.area_to[from] + s.area_to[at(to)];
    for (Index i = from + 1; i < to; ++i) {
        inner += s.length[spoke(i)];
        cotangent += s.cotangent[spoke(i)];
        bend += s.bend[spoke(i)];
    }
    const double wings = (s.length[spoke(from)] + s.length[spoke(to)]) / 2;
    const double outer = (s.cotangent[spoke(from)] + s.cotangent[spoke(to)]) / 2;
    const double edges = std::max<Index>(m - 1, 1);
    const int kind = fan.kind == Fan::inside ? 0 : 1, size = std::min<int>(m, 9) + 10 * kind;  // below 20
    const int v1 = clamp(s.valence[spoke(from)], 11), v2 = clamp(s.valence[spoke(to)], 11);
    const int rest = clamp(d - m + 2, 15);
    Candidate c;
    c.fan = fan;
    const auto cot_bucket = [](double x) {
        return clamp(static_cast<int>((std::min(std::max(x, -4.0), 4.0) + 2) * 4), 20);
    };
    const std::array<int, features> value = {size * 16 + rest,
                                             std::min(v1, v2) * 12 + std::max(v1, v2) + 144 * (m > 4) + 288 * kind,
                                             size * buckets + (m > 1 ? ratio_bucket(inner / edges, wings) : 0),
                                             size * buckets + ratio_bucket(area * d, s.total * m),
                                             size * 21 + (m > 1 ? cot_bucket(cotangent / edges) : 0),
                                             size * 21 + cot_bucket(outer),
                                             size * buckets +
                                                 (m > 1 ? clamp(octave_steps(bend / edges, 2) + 20, buckets - 1) : 0),
                                             size * 16 + clamp(d, 15)};
    for (int i = 0; i < features; ++i) {
        c.weight[i] = i * 1024 + value[i];
        c.score += weights_[c.weight[i]];
    }
    candidates_.push_back(c);
}

Fan FanModel::code(BitCoder& coder, const StarShape& shape, const Fan& fan) {
    std::size_t wanted = candidates_.size();
    if (!coder.reads())
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            const Fan& c = candidates_[i].fan;
            if (c.kind == fan.kind && c.faces == fan.faces && (c.kind != Fan::inside || c.start == fan.start))
                wanted = i;
        }
    const std::size_t chosen = code_rank(coder, wanted);
    if (chosen == candidates_.size()) return code_plainly(coder, shape, fan);
    learn(chosen);
    return candidates_[chosen].fan;
}

std::size_t FanModel::code_rank(BitCoder& coder, std::size_t wanted) {
    order_.resize(candidates_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return candidates_[a].share > candidates_[b].share; });
    double left = 1;
    for (std::size_t rank = 0; rank < order_.size(); ++rank) {
        const Candidate& c = candidates_[order_[rank]];
        const double chance = left > 1e-6 ? std::min(c.share / left, 1.0) : 0.5;
        const int share = clamp(static_cast<int>(chance * 63), 63), place = clamp(static_cast<int>(rank), 15);
        const int next = rank + 1 < order_.size() && left > 1e-6
                             ? clamp(static_cast<int>(candidates_[order_[rank + 1]].share / left * 15), 15)
                             : 0;
        const int faces = std::min<int>(c.fan.faces, 15);
        if (is_it_.code(coder, order_[rank] == wanted,
                        {share, share * 16 + place, place * 16 + faces, next * 64 + share}, place))
            return order_[rank];
        left -= c.share;
    }
    return candidates_.size();
}

void FanModel::learn(std::size_t chosen) {
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
        const Candidate& c = candidates_[i];
        const double step = (i == chosen ? 1 : 0) - c.share;
        if (step > -1e-3 && step < 1e-3) continue;
        for (const int w : c.weight) {
            squares_[w] += step * step;
            weights_[w] += 0.35 * step / std::sqrt(squares_[w]);
        }
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
