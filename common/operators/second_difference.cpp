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

/// The sums over the edges of one row.
class LeastSquares {
public:
    LeastSquares(const StarGeometry& star, double* weight) : star_(star), weight_(weight) {}

    /// Adds the spoke to neighbour j, between the triangles i = j-1 and j.
    void spoke(Index i, Index j, Index k) {
        if (star_.solid[i] * star_.solid[j] == 0) return;
        const double own = -(star_.cot2[i] + star_.cot1[j]);
        const double scale = own / star_.square[j];
        weight_[j] += scale * (star_.cot0[i] + star_.cot0[j]);
        weight_[i] -= scale * (star_.cot0[i] + star_.cot2[i]);
        weight_[k] -= scale * (star_.cot0[j] + star_.cot1[j]);
        divisor_ += scale * own;
        squares_ += (own * own + std::pow(star_.cot0[i] + star_.cot0[j], 2)) / star_.square[j];
    }

    /// Adds the link edge from neighbour j to k, between triangle j and the flap vertex at `f`.
    void link(Index j, Index k, const Vec3& f, Index slot, double degenerate) {
        if (star_.solid[j] == 0) return;
        const double ex = star_.x[k] - star_.x[j], ey = star_.y[k] - star_.y[j], ez = star_.z[k] - star_.z[j];
        const double gx = f.x() - star_.x[j], gy = f.y() - star_.y[j], gz = f.z() - star_.z[j];
        const double e2 = ex * ex + ey * ey + ez * ez, g2 = gx * gx + gy * gy + gz * gz;
        const double d = ex * gx + ey * gy + ez * gz;
        const double cx = ey * gz - ez * gy, cy = ez * gx - ex * gz, cz = ex * gy - ey * gx;
        const double a = std::sqrt(cx * cx + cy * cy + cz * cz);
        if (!(a > degenerate * 2 * (e2 + g2 - d))) return;
        const double inverse = 1 / a, cot_j = d * inverse, cot_k = (e2 - d) * inverse;
        const double own = star_.cot1[j] + star_.cot2[j];
        const double scale = own / e2;
        weight_[slot] -= scale * (cot_j + cot_k);
        weight_[j] += scale * (star_.cot2[j] + cot_k);
        weight_[k] += scale * (star_.cot1[j] + cot_j);
        divisor_ += scale * own;
        squares_ += scale * own;
    }

    /// Divides by sum_e c_e,i^2; false if the differences do not depend on the vertex.
    bool solve(Index columns) {
        if (!(divisor_ > 1e-20 * squares_)) return false;
        const double inverse = 1 / divisor_;
        for (Index k = 0; k < columns; ++k) weight_[k] *= inverse;
        return true;
    }

private:
    const StarGeometry& star_;
    double* weight_;
    double divisor_ = 0, squares_ = 0;
};

}  // namespace

bool second_difference(const StarGeometry& star, const std::uint8_t* feature, const Flaps* flaps, Index columns,
                       double* weight) {
    const Index n = star.size;
    std::fill_n(weight, columns, 0.0);
    LeastSquares sum(star, weight);
    for (Index j = 0; j < n; ++j) {
        if (feature == nullptr || feature[j] == 0) sum.spoke(j > 0 ? j - 1 : n - 1, j, j + 1 < n ? j + 1 : 0);
    }
    if (flaps != nullptr) {
        for (Index j = 0; j < n; ++j) {
            if (flaps->slot[j] < 0) continue;
            const Vec3 f = (*flaps->positions)[flaps->vertex[j]] - flaps->center;
            sum.link(j, j + 1 < n ? j + 1 : 0, f, flaps->slot[j], flaps->degenerate);
        }
    }
    return sum.solve(columns);
}

}  // namespace multires::kernels
