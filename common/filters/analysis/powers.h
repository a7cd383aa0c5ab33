#pragma once

#include <cmath>

namespace multires {

/// Weighted sums of the powers of numbers.
struct Powers {
    double weight = 0, first = 0, second = 0, third = 0;
    Powers& operator+=(const Powers& o) {
        weight += o.weight, first += o.first, second += o.second, third += o.third;
        return *this;
    }
    void add(double w, double x) { *this += {w, w * x, w * x * x, w * x * x * x}; }

    /// 0 if all numbers are alike.
    double skewness() const {
        if (!(weight > 0)) return 0;
        const double m = first / weight, square = second / weight, variance = square - m * m;
        if (!(variance > 1e-12 * square)) return 0;
        return (third / weight - 3 * m * square + 2 * m * m * m) / std::pow(variance, 1.5);
    }
};

}  // namespace multires
