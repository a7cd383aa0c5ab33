#pragma once

#include "stream/two.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace multires::stream {

/// Linear least squares that learns from sample to sample and forgets slowly; `n` features.
/// @tparam Number  double, or Two: two regressions side by side, to the same last bit
template <int n, class Number = double>
class Regression {
public:
    using Features = std::array<Number, n>;

    /// @param start  the weights before anything has been learned
    explicit Regression(const std::array<double, n>& start) {
        std::copy(start.begin(), start.end(), start_.begin());
        weight_ = start_;
    }

    Number predict(const Features& f) const {
        Number sum = 0;
        for (int i = 0; i < n; ++i) sum += weight_[i] * f[i];
        return sum;
    }

    void learn(const Features& f, Number target) {
        add_products(f);
        for (int i = 0; i < n; ++i) b_[i] += f[i] * target;
    }

    /// Ends a sample, which may be several calls of learn(); every now and then the weights are found anew.
    void end_sample() {
        if (++samples_ % interval != 0) return;
        solve();
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j <= i; ++j) a_[i][j] = a_[i][j] * keep;
            b_[i] = b_[i] * keep;
        }
    }

private:
    static constexpr int interval = 16;
    static constexpr double keep = 0.99, ridge = 0.3;
    static constexpr int row = (n + 1) / 2 * 2;

    /// Only the lower triangle is read.
    void add_products(const std::array<double, n>& f) {
        std::array<double, row> padded{};
        std::copy(f.begin(), f.end(), padded.begin());
        for (int i = 0; i < n; ++i) {
            const Two by = f[i];
            for (int j = 0; j <= i; j += 2) (Two(&a_[i][j]) + by * Two(&padded[j])).store(&a_[i][j]);
        }
    }
    void add_products(const std::array<Two, n>& f) {
        for (int i = 0; i < n; ++i)
            for (int j = 0; j <= i; ++j) a_[i][j] += f[i] * f[j];
    }

    /// Cholesky; the ridge keeps it definite and draws the weights to where they started. Where rounding, or numbers
    /// that are none, make it indefinite the weights stay.
    void solve() {
        std::array<std::array<Number, n>, n> l{};
        Features x{};
        Number definite = 1;  // 0 from the first number on that has no root
        for (int i = 0; i < n; ++i) {
            Number sum = b_[i] + ridge * start_[i];
            for (int j = 0; j <= i; ++j) {
                Number s = a_[i][j] + (i == j ? ridge : 0);
                for (int k = 0; k < j; ++k) s = s - l[i][k] * l[j][k];
                if (i != j)
                    l[i][j] = s / l[j][j];
                else
                    definite = where_positive(definite, s), l[i][i] = root(s);
            }
            for (int j = 0; j < i; ++j) sum = sum - l[i][j] * x[j];
            x[i] = sum / l[i][i];
        }
        for (int i = n - 1; i >= 0; --i) {
            for (int j = i + 1; j < n; ++j) x[i] = x[i] - l[j][i] * x[j];
            x[i] = x[i] / l[i][i];
        }
        for (int i = 0; i < n; ++i) weight_[i] = where_positive(x[i], definite, weight_[i]);
    }

    Features start_, weight_, b_{};
    std::array<std::array<Number, row>, n> a_{};
    long samples_ = 0;
};

}  // namespace multires::stream
