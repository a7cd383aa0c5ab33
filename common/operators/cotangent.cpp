#include "operators/kernels.h"

#include <algorithm>
#include <cmath>

// The spoke to neighbour j is opposite neighbour j+1 in triangle j (cot2[j]) and opposite neighbour j-1 in triangle j-1
// (cot1[j-1]). The two cotangents that a triangle adds to a row sum to (opposite side)^2 / (2 area) > 0, so the sum of
// a plain row is positive whenever one triangle is valid.

namespace multires::kernels {

namespace {

/// Divides by the sum; false if there is nothing to divide, or if the cotangents were beyond all bounds: flips across
/// spokes so short that their squares underflow leave triangles without an area.
bool normalise(double* weight, Index size) {
    double sum = 0;
    for (Index j = 0; j < size; ++j) sum += weight[j];
    const double inverse = 1 / sum;
    if (!(inverse > 0) || std::isinf(inverse)) return false;
    for (Index j = 0; j < size; ++j) weight[j] *= inverse;
    return true;
}

/// The star as a ring of intrinsic triangles, from which spokes can be flipped away.
///
/// Triangle j lies between the spokes j and next[j] and is stored as the dot product d = r_j r_k cos(angle) and cross
/// product c = r_j r_k sin(angle) of its spokes, so flips need neither roots nor trigonometry.
class SpokeFlips {
public:
    explicit SpokeFlips(StarGeometry& star) : star_(star), alive_(star.size) {
        for (Index j = 0; j < star.size; ++j) {
            star.next[j] = j + 1 < star.size ? j + 1 : 0;
            star.previous[j] = j > 0 ? j - 1 : star.size - 1;
        }
    }

    /// Flips until every spoke that is left is locally Delaunay or 3 are left. Each flip steps back by one spoke, so
    /// the walk takes O(n) steps. `checked` spokes before `at` are known to be Delaunay.
    void run() {
        Index at = 0, checked = 0;
        while (checked < alive_ && alive_ > 3) {
            if (flip(at)) {
                checked = std::max<Index>(0, std::min(checked, alive_ - 1) - 1);
                at = star_.previous[at];
            } else {
                ++checked;
                at = star_.next[at];
            }
        }
        first_ = at;
    }

    /// The cotangents of the triangles that are left.
    void weights(double* weight) const {
        std::fill_n(weight, star_.size, 0.0);
        Index j = first_;
        for (Index count = 0; count < alive_; ++count, j = star_.next[j]) {
            if (star_.valid[j] == 0) continue;
            const Index k = star_.next[j];
            const double inverse = 1 / star_.area[j];
            weight[j] += (star_.square[k] - star_.dot[j]) * inverse;
            weight[k] += (star_.square[j] - star_.dot[j]) * inverse;
        }
        for (j = 0; j < star_.size; ++j) weight[j] = std::max(weight[j], 0.0);
    }

private:
    /// Flips spoke j if the angles opposite to it sum to more than 180 degrees. The unfolded quadrilateral is convex
    /// then (its other two angles sum to less than 180), so the merged triangle is a triangle.
    bool flip(Index j) {
        const Index i = star_.previous[j], k = star_.next[j];
        const double d1 = star_.dot[i], c1 = star_.area[i], d2 = star_.dot[j], c2 = star_.area[j];
        const double sum = (star_.square[i] - d1) * c2 + (star_.square[k] - d2) * c1;  // has the sign of cot + cot
        if (sum >= 0 && !is_hidden(i, j, k)) return false;
        const double c = c1 * d2 + d1 * c2;  // sine and cosine of the sum of both angles
        if (!(c > 0)) return false;          // a spoke of no length has no angle, nothing is unfolded across it
        star_.area[i] = c / star_.square[j];
        star_.dot[i] = (d1 * d2 - c1 * c2) / star_.square[j];
        star_.valid[i] = std::max(star_.valid[i], star_.valid[j]);
        star_.next[i] = k;
        star_.previous[k] = i;
        --alive_;
        return true;
    }

    /// True if a degenerate triangle shows that neighbour j lies behind i or k, or on one of them (then one is hidden).
    bool is_hidden(Index i, Index j, Index k) const {
        return (star_.valid[i] == 0 && star_.dot[i] > 0 && star_.square[j] > star_.square[i]) ||
               (star_.valid[j] == 0 && star_.dot[j] > 0 && star_.square[j] >= star_.square[k]);
    }

    StarGeometry& star_;
    Index alive_, first_ = 0;
};

/// A vertex on the segment between neighbours j and j+1: the limit of the cotangent weights interpolates along it.
bool on_link_edge(const StarGeometry& star, double* weight) {
    for (Index j = 0; j < star.size; ++j) {
        const double d = star.dot[j], least = std::min(star.square[j], star.square[j + 1]);
        if (star.valid[j] != 0 || d >= 0 || least <= 1e-12 * std::max(star.square[j], star.square[j + 1])) continue;
        const Index k = j + 1 < star.size ? j + 1 : 0;
        std::fill_n(weight, star.size, 0.0);
        weight[j] = star.square[k] - d;
        weight[k] = star.square[j] - d;
        return true;
    }
    return false;
}

}  // namespace

bool cotangent(const StarGeometry& star, double* weight) {
    const Index n = star.size;
    weight[0] = star.cot2[0] + star.cot1[n - 1];
    for (Index j = 1; j < n; ++j) weight[j] = star.cot2[j] + star.cot1[j - 1];
    return normalise(weight, n);
}

bool cotangent_clamped(const StarGeometry& star, double largest, double* weight) {
    const Index n = star.size;
    const auto limit = [largest](double cotangent) { return std::max(-largest, std::min(largest, cotangent)); };
    weight[0] = std::max(0.0, limit(star.cot2[0]) + limit(star.cot1[n - 1]));
    for (Index j = 1; j < n; ++j) weight[j] = std::max(0.0, limit(star.cot2[j]) + limit(star.cot1[j - 1]));
    return normalise(weight, n);
}

// Fisher et al. (2006) and Sharp & Crane (2020) flip every edge of the mesh until the intrinsic triangulation of the
// whole surface is Delaunay; link edges flip too, so vertices get neighbours outside their 1-ring, and the matrix is
// symmetric. Here each star is treated on its own and only its spokes flip: columns stay within the 1-ring, rows can be
// made one vertex at a time, and both properties that relaxation needs are kept: nonnegative weights, and linear
// functions reproduced on planar meshes (the star that is left is a valid star in the plane). The matrix is not
// symmetric. Where the mesh is Delaunay all three agree. In a planar star the flips that are left do not depend on the
// order: under inversion x -> x / |x|^2 about the vertex, the neighbours that keep their spokes are the corners of the
// convex hull. On sharp cones (total angle below 180 degrees) 3 spokes may be left of which one is negative; it is
// set to 0.
bool cotangent_delaunay(StarGeometry& star, double* weight) {
    const Index n = star.size;
    double least = 0, all_valid = 1;
    weight[0] = star.cot2[0] + star.cot1[n - 1];
    for (Index j = 1; j < n; ++j) weight[j] = star.cot2[j] + star.cot1[j - 1];
    for (Index j = 0; j < n; ++j) {
        least = std::min(least, weight[j]);
        all_valid *= star.valid[j];
    }
    if (least < 0 || all_valid == 0) {
        if (all_valid == 0 && on_link_edge(star, weight)) return normalise(weight, n);
        SpokeFlips flips(star);
        flips.run();
        flips.weights(weight);
    }
    return normalise(weight, n);
}

}  // namespace multires::kernels
