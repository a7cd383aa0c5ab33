#include "grids/affine.h"

namespace multires {
namespace {

/// Calls visit(i, j, place) for the samples.
template <class Visit>
void for_samples(const Mask& mask, const Visit& visit) {
    for (Index i = 0; i < mask.rows; ++i)
        for (Index j = 0; j < mask.columns; ++j)
            if (mask.row(i)[j]) visit(i, j, static_cast<std::size_t>(i) * mask.columns + j);
}

}  // namespace

AffineFit::AffineFit(const Mask& mask) {
    double i_sum = 0, j_sum = 0;
    for_samples(mask, [&](Index i, Index j, std::size_t) { i_sum += i, j_sum += j, ++count_; });
    mean_i_ = i_sum / count_, mean_j_ = j_sum / count_;
    for_samples(mask, [&](Index i, Index j, std::size_t) {
        const double a = i - mean_i_, b = j - mean_j_;
        ii_ += a * a / count_, ij_ += a * b / count_, jj_ += b * b / count_;
    });
}

Affine AffineFit::of(const Mask& mask, const Raster& samples) const {
    // Relative to one of them, so that equal ones leave nothing to round.
    std::size_t first = 0;
    while (!mask.values[first]) ++first;
    const double origin = samples.values[first];
    double sum = 0, pi = 0, pj = 0;
    for_samples(mask, [&](Index i, Index j, std::size_t p) {
        const double x = samples.values[p] - origin;
        sum += x, pi += (i - mean_i_) * x / count_, pj += (j - mean_j_) * x / count_;
    });
    Affine out;
    out.middle = origin + sum / count_;
    const double determinant = ii_ * jj_ - ij_ * ij_;
    if (determinant > 1e-9 * (ii_ + jj_)) {
        out.along_i = (jj_ * pi - ij_ * pj) / determinant;
        out.along_j = (ii_ * pj - ij_ * pi) / determinant;
    }
    return out;
}

}  // namespace multires
