#include "stream/fan_model.h"

#include "base/error.h"
#include "stream/geometry.h"

#include <algorithm>

namespace multires::stream {
namespace {

constexpr int buckets = 24, most_valence = 11;

/// x / n: the same number without a division, which takes most of the time, if n is a power of two.
Two over(Two x, Index n) {
    if (n == 1) return x;
    if (n == 2) return x * 0.5;
    return n == 4 ? x * 0.25 : x / static_cast<double>(n);
}

/// log2 of ratios of numbers that are not negative, in steps of a third of an octave from 2^-4 to 2^4; 0: or less, or
/// b = 0.
void store_ratio(Two a, Two b, std::int64_t* to) {
    constexpr double least = 0.0625, most = 15.9;  // in the first bucket and in the last
    store_octaves(smaller(larger(where_positive(a / b, b), least), most), 3, buckets / 2, to);
}

/// In steps of a quarter from -2 to 3.
void store_cotangent(Two x, std::int64_t* to) { store_whole(smaller(larger((x + 2) * 4, 0), 20), to); }

/// Weights of what has few values, by size and kind of the fan and by feature; those of the valences are behind them.
constexpr Index values_of_feature = 32, sizes = 20;
constexpr Index row_of_size(int size) { return size * 8 * values_of_feature; }
constexpr int valence_feature = 1;
constexpr Index valence_weights = row_of_size(sizes);

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
    const std::size_t room = star.spoke.size() + overhang + 1;
    if (room > room_) {
        room_ = room;
        numbers_.assign(room_ * all_columns, 0);
    }
    measure_rays(mesh, u);
    measure_faces();
    turn_again();
}

void StarShape::measure_rays(const StarMesh& mesh, Index u) {
    const Index d = star.faces();
    double *const rx = column(x), *const ry = column(y), *const rz = column(z), *const v = column(valence);
    const Vec3& centre = mesh.point(u);
    for (Index i = 0; i <= d; ++i) {
        const Vec3& p = mesh.point(star.spoke[i]);
        rx[i] = p[0] - centre[0], ry[i] = p[1] - centre[1], rz[i] = p[2] - centre[2];
        v[i] = clamp(mesh.valence(star.spoke[i]), most_valence);
    }
    for (Index i = 0; i <= d; i += 2) {
        const Two a(rx + i), b(ry + i), c(rz + i), squares = (a * a + b * b) + c * c;
        squares.store(column(square) + i), root(squares).store(column(length) + i);
    }
}

void StarShape::measure_faces() {
    const Index d = star.faces();
    const double *const rx = column(x), *const ry = column(y), *const rz = column(z);
    double* const n[3] = {column(normal_x), column(normal_y), column(normal_z)};
    double *const first = column(first_cotangent), *const second = column(second_cotangent);
    double *const cot = column(cotangent), *const turn = column(bend), *const area = column(area_to);
    for (Index i = 0; i < d; i += 2) {
        const Two ax(rx + i), ay(ry + i), az(rz + i), bx(rx + i + 1), by(ry + i + 1), bz(rz + i + 1);
        const Two nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
        const Two twice = root((nx * nx + ny * ny) + nz * nz);
        const Two dx = bx - ax, dy = by - ay, dz = bz - az;
        // Faces without an area have no cotangents, and normals of length 0.
        where_positive(nx / twice, twice).store(n[0] + i), where_positive(ny / twice, twice).store(n[1] + i);
        where_positive(nz / twice, twice).store(n[2] + i);
        where_positive(((bx * dx + by * dy) + bz * dz) / twice, twice).store(first + i);
        where_positive((0 - ((ax * dx + ay * dy) + az * dz)) / twice, twice).store(second + i);
        twice.store(area + i + 1);
    }
    area[0] = 0;
    for (Index i = 0; i < d; ++i) area[i + 1] = area[i] + area[i + 1] / 2;
    total = area[d];
    const auto cosine = [&](Index i, Index j) { return (n[0][i] * n[0][j] + n[1][i] * n[1][j]) + n[2][i] * n[2][j]; };
    for (Index i = 1; i < d; ++i) cot[i] = second[i - 1] + first[i], turn[i] = 1 - cosine(i - 1, i);
    cot[0] = first[0], cot[d] = second[d - 1], turn[0] = turn[d] = 0;
    if (!star.closed) return;
    cot[0] = cot[d] = first[0] + second[d - 1];
    turn[0] = turn[d] = 1 - cosine(d - 1, 0);
}

void StarShape::turn_again() {
    const Index d = star.faces();
    std::fill_n(column(turned), d + 1, 0.0);
    if (star.closed) std::fill_n(column(turned) + d + 1, overhang, total);
    for (int c = 0; c < columns; ++c) {
        if (c == turned) continue;
        double* const numbers = column(c);
        for (Index i = d + 1; i <= d + overhang; ++i) numbers[i] = star.closed ? numbers[i - d] : 0;
    }
}

FanModel::FanModel(bool first_models) : first_models_(first_models), is_it_({64, 64 * 16, 16 * 16, 16 * 64}, 16) {
    weights_.assign(valence_weights + 4 * 144, 0);
    squares_.assign(weights_.size(), 1);
}

void FanModel::rank(const StarShape& shape) {
    const auto d = static_cast<std::size_t>(shape.star.faces());
    const std::size_t most = (d + 2) * (most_faces + 1);
    if (candidates_.size() < most) candidates_.resize(most), score_.resize(most), values_.resize(2 * features * most);
    count_ = values_count_ = 0;
    rank_inside(shape);
    if (!shape.star.closed) rank_at_ends(shape);
    evidence_ = -20;
    for (std::size_t i = 0; i < count_; ++i) evidence_ = std::max(evidence_, score_[i]);
    if (first_models_) find_shares();
}

/// Adds the edges at one spoke of each fan.
template <class Spokes>
void FanModel::Inner::add(const Spokes& at, Index spoke) {
    length += at(StarShape::length, spoke), cotangent += at(StarShape::cotangent, spoke);
    bend += at(StarShape::bend, spoke), squares += at(StarShape::square, spoke);
    x += at(StarShape::x, spoke), y += at(StarShape::y, spoke), z += at(StarShape::z, spoke);
}

/// Scores of two fans of as many faces; leaves their features' values at the end of values_.
/// @param at     Two(Column, Index): of both fans' spokes, counted from their first
/// @param kind   0: inside
/// @param inner  of the fans' edges but the last inner one, which is added
template <class Spokes>
Two FanModel::score(const StarShape& shape, const Spokes& at, Index m, int kind, Inner& inner) {
    const Index d = shape.star.faces(), edges = m - 1;
    const int size = m + 10 * kind;
    std::int64_t* const value = &values_[values_count_];
    values_count_ += 2 * features;
    const auto place = [&](int feature) { return value + 2 * feature; };
    const auto ends = [&](StarShape::Column c) { return at(c, 0) + at(c, m); };
    const Two wings = ends(StarShape::length) * 0.5, outer = ends(StarShape::cotangent) * 0.5;
    const Two area = at(StarShape::turned, m) - at(StarShape::area_to, 0) + at(StarShape::area_to, m);
    const Two a = at(StarShape::valence, 0), b = at(StarShape::valence, m);
    value[0] = value[1] = clamp(d - m + 2, 15);
    store_whole(smaller(a, b) * (most_valence + 1) + larger(a, b) + (144 * static_cast<int>(m > 4) + 288 * kind),
                place(valence_feature));
    store_ratio(area * d, shape.total * m, place(3));
    store_cotangent(outer, place(5));
    if (m > 1) {
        inner.add(at, m - 1);
        store_ratio(over(inner.length, edges), wings, place(2));
        store_cotangent(over(inner.cotangent, edges), place(4));
        store_octaves(smaller(larger(over(inner.bend, edges), 1.0 / 1024), 3.9), 2, 20, place(6));
    } else {
        for (const int feature : {2, 4, 6}) place(feature)[0] = place(feature)[1] = 0;
    }
    if (first_models_) {
        place(7)[0] = place(7)[1] = clamp(d, 15);
    } else {
        // How far the middle of a new vertex's ring is from the parent, relative to how far the ring extends: vertices
        // go to near parents.
        const Two x = inner.x + ends(StarShape::x), y = inner.y + ends(StarShape::y), z = inner.z + ends(StarShape::z);
        const Two middle = (x * x + y * y) + z * z;
        store_ratio(middle, (inner.squares + ends(StarShape::square)) * (m + 2) - middle, place(7));
    }
    const double* const w = weights_.data() + row_of_size(size);
    double one = w[value[0]], other = one;
    one += weights_[valence_weights + value[2]], other += weights_[valence_weights + value[3]];
    for (int f = 2; f < features; ++f)
        one += w[f * values_of_feature + value[2 * f]], other += w[f * values_of_feature + value[2 * f + 1]];
    return {one, other};
}

/// Two fans that start side by side are looked at together.
void FanModel::rank_inside(const StarShape& shape) {
    const Index d = shape.star.faces(), whole = std::min<Index>(most_faces, shape.star.closed ? d - 1 : d);
    std::vector<Index>& most = most_faces_from_;
    most.resize(d + 1);
    most[d] = 0;
    Index free = 0;  // faces from i on
    for (Index i = shape.star.closed ? 2 * d - 1 : d - 1; i >= 0; --i) {
        const Index face = i < d ? i : i - d;
        free = shape.taken[face] ? 0 : free + 1;
        most[face] = std::min(free, whole);
    }
    std::array<const double*, StarShape::columns> column;
    for (int c = 0; c < StarShape::columns; ++c) column[c] = shape[static_cast<StarShape::Column>(c)];
    for (Index i = 0; i < d; ++i) {
        const Index here = most[i], beside = most[i + 1];
        if (here == 0) continue;
        Inner inner;
        const auto at = [&](StarShape::Column c, Index k) { return Two(column[c] + i + k); };
        for (Index m = 1; m <= std::max(here, beside); ++m) {
            const Two both = score(shape, at, m, 0, inner);
            if (m <= here) put(count_ + m - 1, {Fan::inside, i, m}, both.first(), 0);
            if (m <= beside) put(count_ + here + m - 1, {Fan::inside, i + 1, m}, both.second(), 1);
        }
        count_ += here + beside;
        ++i;
    }
}

/// The fans at the first edge of an open star and at the last.
void FanModel::rank_at_ends(const StarShape& shape) {
    const Index d = shape.star.faces();
    for (Index m = 0; m <= std::min<Index>(most_faces, d); ++m) {
        const auto at = [&](StarShape::Column c, Index k) { return Two(shape[c][k], shape[c][d - m + k]); };
        Inner inner;
        for (Index i = 1; i + 1 < m; ++i) inner.add(at, i);
        const Two both = score(shape, at, m, 1, inner);
        if (m == 0 || !shape.taken[m - 1]) put(count_++, {Fan::first, 0, m}, both.first(), 0);
        if (m == 0 || !shape.taken[d - m]) put(count_++, {Fan::last, d - m, m}, both.second(), 1);
    }
}

void FanModel::put(std::size_t at, const Fan& fan, double score, int which) {
    candidates_[at] = {fan, values_count_ - 2 * features + which};
    score_[at] = score;
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
        std::array<Index, features> at;
        const Index row = row_of_size(c.fan.faces + (c.fan.kind == Fan::inside ? 0 : 10));
        for (int k = 0; k < features; ++k)
            at[k] = static_cast<Index>(values_[c.value + 2 * k]) +
                    (k == valence_feature ? valence_weights : row + k * values_of_feature);
        std::array<double, features> by;
        for (int k = 0; k < features; ++k) by[k] = squares_[at[k]] += step * step;
        for (double& x : by) x = 0.35 * step / std::sqrt(x);
        for (int k = 0; k < features; ++k) weights_[at[k]] += by[k];
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
