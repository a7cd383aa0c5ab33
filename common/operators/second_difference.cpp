#include "operators/kernels.h"

#include <algorithm>
#include <cmath>

// Across an edge e = {j, k} with the opposite vertices l1, l2 Guskov's coefficients (eq. 1, hinge map) are, in terms of
// the cotangents of the angles at j and k in triangle 1 and 2 (L_e / A = 2 (cot_j + cot_k) / L_e in each triangle):
//
//     c_l1 = (2 / L_e)  (cot_j1 + cot_k1)        c_j = (2 / L_e) -(cot_k1 + cot_k2)
//     c_l2 = (2 / L_e)  (cot_j2 + cot_k2)        c_k = (2 / L_e) -(cot_j1 + cot_j2)
//
// They sum to 0 (for the paper's form in signed areas to do so, l1 and l2 have to be swapped in its A[k,l1,l2] and
// A[j,l2,l1]). The weights are w_ij = - sum_e c_e,i c_e,j / sum_e c_e,i^2, so the 2 cancels and L_e is needed squared
// only: no root beyond the one of each triangle's area.

namespace multires::kernels {

namespace {

/// The sum of c_e,i^2 over edges, and what rounding in it is measured by.
struct Divisor {
    double value = 0, scale = 0;
};

/// 1 / x where it counts, 0 elsewhere.
double inverse_if(double counts, double x) { return counts != 0 ? 1 / x : 0; }

/// Adds the spokes that are no features; entry j is between the triangles j-1 and j.
///
/// In two loops: what each edge gives to the three vertices around it, without branches, then what each vertex gets.
Divisor add_spokes(StarGeometry& star, const std::uint8_t* feature, double* weight) {
    const Index n = star.size;
    double *to_self = star.scratch[0], *to_previous = star.scratch[1], *to_next = star.scratch[2];
    double *divisor = star.scratch[3], *squares = star.scratch[4];
    const auto spoke = [&](Index i, Index j) {
        const double own = -(star.cot2[i] + star.cot1[j]), other = star.cot0[i] + star.cot0[j];
        const double inverse = inverse_if(star.valid[i] * star.valid[j], star.square[j]), scale = own * inverse;
        to_self[j] = scale * other;
        to_previous[j] = scale * (star.cot0[i] + star.cot2[i]);
        to_next[j] = scale * (star.cot0[j] + star.cot1[j]);
        divisor[j] = scale * own;
        squares[j] = inverse * (own * own + other * other);
    };
    spoke(n - 1, 0);
    for (Index j = 1; j < n; ++j) spoke(j - 1, j);
    if (feature != nullptr)
        for (Index j = 0; j < n; ++j)
            if (feature[j] != 0) to_self[j] = to_previous[j] = to_next[j] = divisor[j] = squares[j] = 0;
    Divisor sum;
    for (Index j = 0; j < n; ++j) {
        weight[j] += to_self[j] - to_previous[j + 1 < n ? j + 1 : 0] - to_next[j > 0 ? j - 1 : n - 1];
        sum.value += divisor[j], sum.scale += squares[j];
    }
    return sum;
}

/// Adds the link edges; entry j is between triangle j and its flap. A flap that is none lies at neighbour j and makes a
/// degenerate triangle.
Divisor add_links(StarGeometry& star, const Flaps& flaps, double* weight) {
    const Index n = star.size;
    double *fx = star.scratch[0], *fy = star.scratch[1], *fz = star.scratch[2];
    double *to_self = star.scratch[3], *to_next = star.scratch[4], *divisor = star.scratch[5];
    for (Index j = 0; j < n; ++j) {
        const Vec3 f = (*flaps.positions)[flaps.vertex[j]];
        fx[j] = f.x() - flaps.center.x(), fy[j] = f.y() - flaps.center.y(), fz[j] = f.z() - flaps.center.z();
    }
    for (Index j = 0; j < n; ++j) {
        const double ex = star.x[j + 1] - star.x[j], ey = star.y[j + 1] - star.y[j], ez = star.z[j + 1] - star.z[j];
        const double gx = fx[j] - star.x[j], gy = fy[j] - star.y[j], gz = fz[j] - star.z[j];
        const double e2 = ex * ex + ey * ey + ez * ez, g2 = gx * gx + gy * gy + gz * gz;
        const double d = ex * gx + ey * gy + ez * gz;
        const double cx = ey * gz - ez * gy, cy = ez * gx - ex * gz, cz = ex * gy - ey * gx;
        const double a = std::sqrt(cx * cx + cy * cy + cz * cz);
        const double counts = a > flaps.degenerate * 2 * (e2 + g2 - d) ? star.valid[j] : 0;
        const double inverse = inverse_if(counts, a), cot_j = d * inverse, cot_k = (e2 - d) * inverse;
        const double own = star.cot1[j] + star.cot2[j], scale = own * inverse_if(counts, e2);
        flaps.weight[j] = -scale * (cot_j + cot_k);
        to_self[j] = scale * (star.cot2[j] + cot_k);
        to_next[j] = scale * (star.cot1[j] + cot_j);
        divisor[j] = scale * own;
    }
    Divisor sum;
    for (Index j = 0; j < n; ++j) {
        weight[j] += to_self[j] + to_next[j > 0 ? j - 1 : n - 1];
        sum.value += divisor[j];
    }
    sum.scale = sum.value;
    return sum;
}

}  // namespace

bool second_difference(StarGeometry& star, const std::uint8_t* feature, const Flaps* flaps, double* weight) {
    const Index n = star.size;
    std::fill_n(weight, n, 0.0);
    Divisor divisor = add_spokes(star, feature, weight);
    if (flaps != nullptr) {
        const Divisor links = add_links(star, *flaps, weight);
        divisor.value += links.value, divisor.scale += links.scale;
    }
    if (!(divisor.value > 1e-20 * divisor.scale)) return false;  // the differences do not depend on the vertex
    const double inverse = 1 / divisor.value;
    for (Index k = 0; k < n; ++k) weight[k] *= inverse;
    if (flaps != nullptr)
        for (Index k = 0; k < n; ++k) flaps->weight[k] *= inverse;
    return true;
}

}  // namespace multires::kernels
