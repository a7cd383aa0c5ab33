#include "operators/star.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace multires {

void StarGeometry::reserve(Index n) {
    size = n;
    if (n + 1 <= capacity_) return;
    capacity_ = std::max<Index>({n + 1, 2 * capacity_, 64});
    double** const arrays[] = {&x, &y, &z, &square, &dot, &area, &valid, &cot0, &cot1, &cot2};
    memory_.resize((std::size(arrays) + scratch.size()) * static_cast<std::size_t>(capacity_));
    double* at = memory_.data();
    for (double** array : arrays) {
        *array = at;
        at += capacity_;
    }
    for (double*& array : scratch) {
        array = at;
        at += capacity_;
    }
    next.resize(capacity_);
    previous.resize(capacity_);
}

void StarGeometry::load(const Star& star, const Positions& positions, double degenerate) {
    reserve(star.size);
    const Vec3 center = positions[star.vertex];
    const auto spoke = [&](Index j) -> Vec3 { return positions[star.neighbor[j]] - center; };
    const auto keep = [this](Index j, const Vec3& s, double squared) {
        x[j] = s.x();
        y[j] = s.y();
        z[j] = s.z();
        square[j] = squared;
    };
    const Vec3 first = spoke(0);
    const double first_square = first.squaredNorm();
    keep(0, first, first_square);
    // Both spokes of a triangle stay in registers: reading back what was just written would stall.
    Vec3 s = first;
    double ss = first_square;
    for (Index j = 0; j < size; ++j) {
        const Vec3 t = j + 1 < size ? spoke(j + 1) : first;
        const double tt = j + 1 < size ? t.squaredNorm() : first_square;
        const double st = s.dot(t), cross = s.cross(t).norm();
        const bool is_valid = cross > degenerate * 2 * (ss + tt - st);  // all three sides
        const double inverse = is_valid ? 1 / cross : 0;
        keep(j + 1, t, tt);
        dot[j] = st;
        area[j] = cross;
        valid[j] = is_valid ? 1 : 0;
        cot0[j] = st * inverse;
        cot1[j] = (ss - st) * inverse;
        cot2[j] = (tt - st) * inverse;
        s = t;
        ss = tt;
    }
}

}  // namespace multires
