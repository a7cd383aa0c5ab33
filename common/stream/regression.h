#pragma once

#include <array>
#include <cmath>

namespace multires::stream {

/// Linear least squares that learns from sample to sample and forgets slowly; `n` features.
template <int n>
class Regression {
public:
    using Features = std::array<double, n>;

    /// @param start  the weights before anything has been learned
    explicit Regression(const Features& start) : start_(start), weight_(start) {}

    double predict(const Features& f) const {
        double sum = 0;
        for (int i = 0; i < n; ++i) sum += weight_[i] * f[i];
        return sum;
    }

    void learn(const Features& f, double target) {
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) a_[i][j] += f[i] * f[j];  // half of it is read: whole rows take less time
            b_[i] += f[i] * target;
        }
    }

    /// Ends a sample, which may be several calls of learn(); every now and then the weights are found anew.
    void end_sample() {
        if (++samples_ % interval != 0) return;
        solve();
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) a_[i][j] *= keep;
            b_[i] *= keep;
        }
    }

private:
    static constexpr int interval = 16;
    static constexpr double keep = 0.99, ridge = 0.3;

    /// Cholesky; the ridge keeps it definite and draws the weights to where they started.
    void solve() {
        std::array<std::array<double, n>, n> l{};
        Features x{};
        for (int i = 0; i < n; ++i) {
            double sum = b_[i] + ridge * start_[i];
            for (int j = 0; j <= i; ++j) {
                double s = a_[i][j] + (i == j ? ridge : 0);
                for (int k = 0; k < j; ++k) s -= l[i][k] * l[j][k];
                if (i != j)
                    l[i][j] = s / l[j][j];
                else if (s > 0)
                    l[i][i] = std::sqrt(s);
                else
                    return;  // rounding, or numbers that are none: the weights stay
            }
            for (int j = 0; j < i; ++j) sum -= l[i][j] * x[j];
            x[i] = sum / l[i][i];
        }
        for (int i = n - 1; i >= 0; --i) {
            for (int j = i + 1; j < n; ++j) x[i] -= l[j][i] * x[j];
            x[i] /= l[i][i];
        }
        weight_ = x;
    }

    Features start_, weight_, b_{};
    std::array<std::array<double, n>, n> a_{};
    long samples_ = 0;
};

}  // namespace multires::stream
