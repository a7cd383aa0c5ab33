#include "operators/star.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace multires {

void StarGeometry::reserve(Index n) {
    size = n;
    if (n + 1 <= capacity_) return;
    capacity_ = std::max<Index>({n + 1, 2 * capacity_, 64});
    double** const arrays[] = {&x, &y, &z, &square, &dot, &area, &solid, &cot0, &cot1, &cot2};
    memory_.resize(std::size(arrays) * static_cast<std::size_t>(capacity_));
    double* at = memory_.data();
    for (double** array : arrays) {
        *array = at;
        at += capacity_;
    }
    next.resize(capacity_);
    previous.resize(capacity_);
}

void StarGeometry::load(const Star& star, const Positions& positions, double degenerate) {
    reserve(star.size);
    const Index n = size;
    const Vec3 center = positions[star.vertex];
    for (Index j = 0; j < n; ++j) {
        const Vec3& p = positions[star.neighbor[j]];
        x[j] = p.x() - center.x();
        y[j] = p.y() - center.y();
        z[j] = p.z() - center.z();
    }
    x[n] = x[0];
    y[n] = y[0];
    z[n] = z[0];
    for (Index j = 0; j <= n; ++j) square[j] = x[j] * x[j] + y[j] * y[j] + z[j] * z[j];
    for (Index j = 0; j < n; ++j) {
        const double d = x[j] * x[j + 1] + y[j] * y[j + 1] + z[j] * z[j + 1];
        const double cx = y[j] * z[j + 1] - z[j] * y[j + 1];
        const double cy = z[j] * x[j + 1] - x[j] * z[j + 1];
        const double cz = x[j] * y[j + 1] - y[j] * x[j + 1];
        const double a = std::sqrt(cx * cx + cy * cy + cz * cz);
        const double squares = 2 * (square[j] + square[j + 1] - d);  // all three sides
        const bool is_solid = a > degenerate * squares;
        const double inverse = (is_solid ? 1.0 : 0.0) / (is_solid ? a : 1.0);
        dot[j] = d;
        area[j] = a;
        solid[j] = is_solid ? 1.0 : 0.0;
        cot0[j] = d * inverse;
        cot1[j] = (square[j] - d) * inverse;
        cot2[j] = (square[j + 1] - d) * inverse;
    }
}

}  // namespace multires
