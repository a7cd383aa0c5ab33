#include "stream/place_model.h"

#include "base/error.h"
#include "stream/bit_model.h"
#include "stream/geometry.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace multires::stream {
namespace {

/// The nearest cell of a coordinate, whatever the coordinate is.
std::int32_t nearest(double x) {
    constexpr double most = 1 << 26;  // cells have 24 bits
    return x >= -most && x <= most ? static_cast<std::int32_t>(std::floor(x + 0.5)) : 0;
}

std::int32_t sum(std::int32_t guess, std::int32_t rest) {
    require(std::abs(static_cast<std::int64_t>(rest)) < 1 << 28, "the stream is damaged: a place outside the box");
    return guess + rest;
}

}  // namespace

PlaceModel::PlaceModel(bool with_experts)
    : with_experts_(with_experts), place_{Regression<points>({0.1, 0, 0.05, 0, 1.2, 0}),
                                          Regression<points>({0, 0, 0, 0, 0, 0})},
      height_{Regression<heights>({0.3, 0, 0.3, 0, 0}), Regression<heights>({0.3, 0, 0.3, 0, 0})},
      along_{ResidualModel(with_experts), ResidualModel(with_experts)}, across_{ResidualModel(with_experts),
                                                                                ResidualModel(with_experts)} {}

Cell PlaceModel::code(BitCoder& coder, const StarMesh& mesh, const Star& star, Index v, Index parent,
                      const Cell& cell) {
    star_ = &star;
    take(mesh, parent);
    Cell out = cell;
    out[axes_[0]] = code_along(coder, axes_[0], cell[axes_[0]]);
    rest_[axes_[0]] = out[axes_[0]] - nearest(predicted_[axes_[0]]);
    out[axes_[1]] = code_along(coder, axes_[1], cell[axes_[1]]);
    rest_[axes_[1]] = out[axes_[1]] - nearest(predicted_[axes_[1]]);
    out[axes_[2]] = code_height(coder, mesh, parent, out);
    const int open = star_->closed ? 0 : 1;
    const double over = 1 / scale_;
    std::array<double, points> f;
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < points; ++i) f[i] = (point_[i][axis] - centre_[axis]) * over;
        place_[open].learn(f, (out[axis] - centre_[axis]) * over);
    }
    place_[open].end_sample();
    missed_along_.resize(mesh.vertices(), -1);
    missed_across_.resize(mesh.vertices(), -1);
    const double a = rest_[axes_[0]], b = rest_[axes_[1]];
    missed_along_[v] = static_cast<float>(std::sqrt(a * a + b * b) * over);
    missed_across_[v] = static_cast<float>(std::abs(rest_[axes_[2]]) * over);
    return out;
}

void PlaceModel::take(const StarMesh& mesh, Index parent) {
    const std::vector<Index>& ring = star_->spoke;
    const Index d = star_->faces(), n = star_->closed ? d : d + 1;
    centre_ = far_ = skew_ = Vec3(0, 0, 0);
    for (Index i = 0; i < n; ++i) centre_ += mesh.point(ring[i]);
    centre_ /= n;
    if (!star_->closed) centre_ = (mesh.point(ring[0]) + mesh.point(ring[d])) / 2;
    up_ = Vec3(0, 0, 0);
    for (Index i = 0; i < d; ++i) up_ += cross(mesh.point(ring[i]) - centre_, mesh.point(ring[i + 1]) - centre_);
    double sum = 0;
    for (Index i = 0; i < n; ++i) {
        const Vec3 r = mesh.point(ring[i]) - centre_;
        sum += dot(r, r);
        far_ += Vec3(r[0] * r[0], r[1] * r[1], r[2] * r[2]);
        skew_ += Vec3(r[1] * r[2], r[2] * r[0], r[0] * r[1]);
    }
    scale_ = std::sqrt(sum / n) + 0.5;
    for (int i = 0; i < 3; ++i) far_[i] /= n, skew_[i] /= n;
    const double size = length(up_);
    up_ = size > 0 ? Vec3(up_ / size) : Vec3(0, 0, 1);
    int top = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(up_[i]) > std::abs(up_[top])) top = i;
    axes_ = {(top + 1) % 3, (top + 2) % 3, top};
    find_normals(mesh);
    find_points(mesh, parent);
    double along = 0, across = 0;
    int known = 0;
    for (Index i = 0; i < n; ++i) {
        if (ring[i] >= static_cast<Index>(missed_along_.size()) || missed_along_[ring[i]] < 0) continue;
        along += missed_along_[ring[i]], across += missed_across_[ring[i]], ++known;
    }
    remembers_ = known > 0;
    memory_along_ = logarithm((known ? along / known : 0.2) * scale_ + 0.3);
    memory_across_ = logarithm((known ? across / known : 0.1) * scale_ + 0.3);
    const Vec3 apart = point_[4] - centre_, ahead = point_[2] - predicted_;
    apart_along_ = logarithm(length(apart) + 0.3), apart_across_ = logarithm(std::abs(dot(ahead, up_)) + 0.3);
}

/// Normals at the ring's vertices, of the faces that are known, and the vertices across the link edges.
void PlaceModel::find_normals(const StarMesh& mesh) {
    const Star& star = *star_;
    const Index d = star.faces(), n = star.closed ? d : d + 1;
    normal_.resize(n), flap_.resize(d), has_flap_.resize(d);
    for (Index i = 0; i < n; ++i) {
        const Vec3& sum = mesh.normal(star.spoke[i]);
        const double size = mesh.regular(star.spoke[i]) ? length(sum) : 0;
        normal_[i] = size > 0 ? Vec3(sum / size) : Vec3(0, 0, 0);
    }
    for (Index i = 0; i < d; ++i) {
        const Index across = mesh.twin(StarMesh::next(star.leaving[i]));
        has_flap_[i] = across >= 0;
        if (across < 0) continue;
        flap_[i] = mesh.point(star.spoke[i]) + mesh.point(star.spoke[i + 1]) -
                   mesh.point(mesh.origin(StarMesh::previous(across)));
    }
}

/// The points that the place is combined of.
void PlaceModel::find_points(const StarMesh& mesh, Index parent) {
    const std::vector<Index>& ring = star_->spoke;
    const Index d = star_->faces(), n = star_->closed ? d : d + 1;
    Index at = 0;
    while (ring[at] != parent && at < d) ++at;
    const Vec3 left = star_->closed || at > 0 ? mesh.point(ring[at > 0 ? at - 1 : d - 1]) : mesh.point(ring[at]);
    const Vec3 right = at < d ? mesh.point(ring[at + 1]) : mesh.point(ring[at]);
    Vec3 flaps(0, 0, 0), edges(0, 0, 0), area(0, 0, 0), opposite(0, 0, 0);
    double count = 0, perimeter = 0, whole = 0;
    for (Index i = 0; i < d; ++i) {
        const Vec3 a = mesh.point(ring[i]), b = mesh.point(ring[i + 1]);
        if (has_flap_[i]) flaps += flap_[i], ++count;
        const double l = length(a - b), t = length(cross(a - mesh.point(parent), b - mesh.point(parent)));
        edges += (a + b) * (l / 2), perimeter += l;
        area += (a + b + mesh.point(parent)) * (t / 3), whole += t;
    }
    double far = 0;
    for (Index i = 0; i < n; ++i) {
        const double l = length(mesh.point(ring[i]) - mesh.point(parent));
        opposite += mesh.point(ring[i]) * l, far += l;
    }
    point_ = {mesh.point(parent),
              (left + right) / 2,
              count > 0 ? Vec3(flaps / count) : centre_,
              perimeter > 0 ? Vec3(edges / perimeter) : centre_,
              whole > 0 ? Vec3(area / whole) : centre_,
              far > 0 ? Vec3(opposite / far) : centre_};
    std::array<double, points> f;
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < points; ++i) f[i] = point_[i][axis] - centre_[axis];
        predicted_[axis] = centre_[axis] + place_[star_->closed ? 0 : 1].predict(f);
    }
    if (with_experts_) find_mode(mesh);
}

/// Places that are right on a regular triangular grid: across the link edges, across two edges of the ring, and between
/// two of its vertices.
void PlaceModel::add_candidates(const StarMesh& mesh) {
    constexpr Index most = 12;  // their number is a square
    const std::vector<Index>& ring = star_->spoke;
    const bool closed = star_->closed;
    const Index d = star_->faces(), n = closed ? d : d + 1;
    candidate_.clear();
    for (Index i = 0; i < d; ++i)
        if (has_flap_[i]) candidate_.push_back(flap_[i]);
    if (n > most) return;
    for (Index i = 0; i < n; ++i) {
        const Vec3& a = mesh.point(ring[i]);
        if (closed || i + 2 < n)
            candidate_.push_back(a + mesh.point(ring[(i + 2) % n]) - mesh.point(ring[(i + 1) % n]));
        for (Index j = i + 2; j < n; ++j)
            if (!closed || i > 0 || j + 1 < n) candidate_.push_back((a + mesh.point(ring[j])) * 0.5);
    }
}

/// Where most candidates lie close together, near the predicted place: the maximum of a density of Cauchy kernels, by
/// mean shift.
void PlaceModel::find_mode(const StarMesh& mesh) {
    constexpr double kernel = 0.01;  // square of its width, of the ring's
    constexpr int steps = 3;
    add_candidates(mesh);
    mode_ = predicted_;
    const double square = kernel * scale_ * scale_;
    for (int step = 0; step < steps; ++step) {
        Vec3 sum(0, 0, 0);
        support_ = 0;
        for (const Vec3& c : candidate_) {
            const Vec3 r = c - mode_;
            const double near = square / (dot(r, r) + square), weight = near * near;
            support_ += weight, sum += weight * c;
        }
        if (support_ > 0) mode_ = sum / support_;
    }
    apart_mode_ = logarithm(length(mode_ - predicted_) + 0.3), log_support_ = logarithm(support_ + 0.1);
}

/// Codes how far a coordinate is from its prediction.
/// @param clues  of each expert; mean_ has their places relative to the prediction
std::int32_t PlaceModel::code_with_experts(BitCoder& coder, std::int32_t rest, ResidualModel& model,
                                           ResidualModel::Contexts& contexts, const Clues& clues, Widths& widths) {
    const Two off = smaller(larger(widths.predict(clues), -3), 24);
    contexts.expected = clamp(static_cast<int>((off.first() + 3) * 5), 63);
    ResidualModel::Opinions opinions;
    opinions.experts = {mean_, Two(1.5, 1) / exponential(0.6931471805599453 * off)};
    opinions.support = clamp(static_cast<int>(support_ * 1.2), 7);
    const std::int32_t out = model.code(coder, rest, contexts, &opinions);
    const Two missed = out - mean_;
    missed_ = logarithm(larger(missed, 0 - missed) + 0.3);
    widths.learn(clues, missed_), widths.end_sample();
    return out;
}

std::int32_t PlaceModel::code_along(BitCoder& coder, int axis, std::int32_t value) {
    const bool second = axis == axes_[1];
    double place = predicted_[axis], square = far_[axis], lever = 0;
    if (second) {  // what the first coordinate's miss says of this one, by the shape of the ring
        const double slope = skew_[axes_[2]] / (far_[axes_[0]] + 0.1);
        place += slope_.predict({slope * off_});
        square = std::max(square - slope * skew_[axes_[2]], 0.0);
        lever = slope * off_;
    }
    const double far = std::sqrt(square);
    const std::int32_t guess = nearest(place);
    ResidualModel::Contexts c;
    const std::array<double, 8> f = {1,
                                     logarithm(far + 0.3),
                                     logarithm(scale_),
                                     memory_along_,
                                     memory_across_,
                                     apart_along_,
                                     apart_across_,
                                     remembers_ ? 1.0 : 0.0};
    const double far_of_first = logarithm(std::sqrt(far_[axes_[0]]) + 0.3);
    c.spread = clamp(octave_steps(far + 0.05, 3) + 12, 63);
    c.memory = remembers_ ? clamp(static_cast<int>(memory_along_ * 3 + 8), 62) : 63;
    c.kind = clamp(star_->faces() - 2, 7) + (second ? 8 : 0);
    const int other = second ? clamp(octave_steps(std::abs(off_) / (std::sqrt(far_[axes_[0]]) + 0.05), 1) + 5, 7) : 0;
    c.other = other * 8 + clamp(octave_steps(scale_, 1), 7);
    c.lean = clamp(static_cast<int>((place - guess + 0.5) * 8), 7) + 8 * clamp(c.spread / 3 - 3, 7);
    ResidualModel& model = along_[star_->closed ? 0 : 1];
    std::int32_t out = 0;
    if (with_experts_) {
        mean_ = Two(place - guess, mode_[axis] - guess);
        const Clues clues = {
            1,           f[1],        f[2], memory_along_, apart_along_, second ? missed_ - far_of_first : Two(),
            apart_mode_, log_support_};
        out = sum(guess, code_with_experts(coder, value - guess, model, c, clues, widths_along_));
    } else {
        Regression<9>::Features g;
        std::copy(f.begin(), f.end(), g.begin());
        g[8] = second ? logarithm(std::abs(off_) + 0.5) - far_of_first : 0.0;
        c.expected = clamp(static_cast<int>((expect_along_.predict(g) + 3) * 5), 63);
        out = sum(guess, model.code(coder, value - guess, c, nullptr));
        expect_along_.learn(g, logarithm(std::abs(out - place) + 0.3)), expect_along_.end_sample();
    }
    if (second)
        slope_.learn({lever / scale_}, (out - predicted_[axis]) / scale_), slope_.end_sample();
    else
        off_ = out - predicted_[axis];
    return out;
}

std::array<double, PlaceModel::heights> PlaceModel::height_features(const StarMesh& mesh, Index parent,
                                                                    const Cell& cell) const {
    const int a = axes_[0], b = axes_[1], w = axes_[2];
    const std::vector<Index>& ring = star_->spoke;
    const Index n = star_->closed ? star_->faces() : star_->faces() + 1;
    const auto plane = [&](const Vec3& at, const Vec3& up) {
        return at[w] - (up[a] * (cell[a] - at[a]) + up[b] * (cell[b] - at[b])) / up[w];
    };
    const double flat = plane(centre_, up_);
    double tangents = 0, tangents_weight = 0, points = 0, points_weight = 0;
    for (Index i = 0; i < n; ++i) {
        const Vec3& r = mesh.point(ring[i]);
        const double x = cell[a] - r[a], y = cell[b] - r[b];
        const double near = 1 / (x * x + y * y + 0.05 * scale_ * scale_ + 0.01);
        points += near * dot(r - centre_, up_) / up_[w], points_weight += near;
        if (normal_[i][w] * up_[w] < 0.3 * up_[w] * up_[w]) continue;  // too steep to go by
        tangents += near * plane(r, normal_[i]), tangents_weight += near;
    }
    const double flaps = plane(point_[2], up_) - flat;
    return {tangents_weight > 0 ? tangents / tangents_weight - flat : 0, points / points_weight, flaps,
            plane(mesh.point(parent), up_) - flat, plane(predicted_, up_) - flat};
}

std::int32_t PlaceModel::code_height(BitCoder& coder, const StarMesh& mesh, Index parent, const Cell& cell) {
    const int a = axes_[0], b = axes_[1], w = axes_[2];
    const int open = star_->closed ? 0 : 1;
    const std::array<double, heights> f = height_features(mesh, parent, cell);
    const double flat = centre_[w] - (up_[a] * (cell[a] - centre_[a]) + up_[b] * (cell[b] - centre_[b])) / up_[w];
    const double height = flat + height_[open].predict(f);
    const std::int32_t guess = nearest(height);
    double most = 0, least = 0;
    for (const double x : f) most = std::max(most, x), least = std::min(least, x);
    ResidualModel::Contexts c;
    c.spread = clamp(octave_steps(most - least + 0.05, 2) + 12, 63);
    const double off = std::sqrt(static_cast<double>(rest_[a]) * rest_[a] + static_cast<double>(rest_[b]) * rest_[b]);
    const std::array<double, 9> g = {1,
                                     logarithm(most - least + 0.3),
                                     logarithm(scale_),
                                     memory_across_,
                                     memory_along_,
                                     apart_across_,
                                     logarithm(off + 0.5),
                                     remembers_ ? 1.0 : 0.0,
                                     logarithm(std::abs(up_[w]))};
    c.memory = remembers_ ? clamp(static_cast<int>(memory_across_ * 3 + 8), 62) : 63;
    c.kind = clamp(star_->faces() - 2, 15);
    c.other =
        clamp(octave_steps(off + 0.05, 1) + 5, 15) * 4 + clamp(static_cast<int>((std::abs(up_[w]) - 0.55) * 8), 3);
    c.lean = clamp(static_cast<int>((height - guess + 0.5) * 8), 7) + 8 * clamp(c.spread / 2 - 3, 7);
    std::int32_t value = 0;
    if (with_experts_) {
        const double off_mode_a = cell[a] - mode_[a], off_mode_b = cell[b] - mode_[b];
        mean_ = Two(height - guess, mode_[w] - (up_[a] * off_mode_a + up_[b] * off_mode_b) / up_[w] - guess);
        const Clues clues = {1,
                             g[1],
                             g[2],
                             memory_across_,
                             apart_across_,
                             g[6],
                             logarithm(std::abs(off_mode_a) + std::abs(off_mode_b) + 0.3),
                             log_support_};
        value = sum(guess, code_with_experts(coder, cell[w] - guess, across_[open], c, clues, widths_across_));
    } else {
        c.expected = clamp(static_cast<int>((expect_across_.predict(g) + 3) * 6), 63);
        value = sum(guess, across_[open].code(coder, cell[w] - guess, c, nullptr));
        expect_across_.learn(g, logarithm(std::abs(value - height) + 0.3)), expect_across_.end_sample();
    }
    rest_[w] = value - guess;
    std::array<double, heights> scaled = f;
    for (double& x : scaled) x /= scale_;
    height_[open].learn(scaled, (value - flat) / scale_);
    height_[open].end_sample();
    return value;
}

}  // namespace multires::stream
