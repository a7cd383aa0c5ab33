#include "denoise/risk.h"

#include "base/reduce.h"

#include <algorithm>

namespace multires {
namespace {

/// Sums over edges and vertices; grows to size when first added to.
struct Sums {
    std::vector<double> values;
    Sums& operator+=(const Sums& o) {
        if (values.empty()) values.assign(o.values.size(), 0);
        for (std::size_t i = 0; i < o.values.size(); ++i) values[i] += o.values[i];
        return *this;
    }
};

/// The places of one risk's sums within Sums::values.
class Layout {
public:
    explicit Layout(int candidates) : count_(candidates) {}
    int size() const { return 2 + count_ + count_ * (count_ + 1) / 2; }

    /// One difference or one height: the expected square of the noise, the probe, and all candidates' u and v.
    void add(double expected, double probe, const double* u, const double* v, double* sums) const {
        sums[0] += 1;
        sums[1] += expected;
        // <A b, A v> of a filter that removes everything is -|A b|^2: its mean is known, so only the rest is sampled.
        const double excess = probe * probe - expected;
        double* to = sums + 2;
        for (int k = 0; k < count_; ++k) *to++ += probe * v[k] + excess;
        for (int k = 0; k < count_; ++k)
            for (int l = 0; l <= k; ++l) *to++ += u[k] * u[l];
    }

    Risk risk(const double* sums) const {
        Risk r;
        r.linear.setZero(count_);
        r.quadratic.setZero(count_, count_);
        if (!(sums[0] > 0)) return r;
        r.constant = sums[1] / sums[0];
        const double* from = sums + 2;
        for (int k = 0; k < count_; ++k) r.linear[k] = *from++ / sums[0];
        for (int k = 0; k < count_; ++k)
            for (int l = 0; l <= k; ++l) r.quadratic(k, l) = r.quadratic(l, k) = *from++ / sums[0];
        return r;
    }

private:
    int count_;
};

}  // namespace

Risks risks(const Neighbours& near, const std::vector<Response>& candidates, const std::vector<double>& deviation,
            const std::vector<double>& probe, const std::vector<std::uint8_t>& core) {
    const int count = static_cast<int>(candidates.size());
    const Layout layout(count);
    const Sums all = chunked_reduce<Sums>(core.size(), [&](std::size_t begin, std::size_t end) {
        Sums part;
        part.values.assign(2 * layout.size(), 0);
        std::vector<double> u(count), v(count);
        for (std::size_t i = begin; i < end; ++i) {
            if (!core[i]) continue;
            const auto square = [&](std::size_t j) { return deviation[j] * deviation[j]; };
            for (int k = 0; k < count; ++k) {
                u[k] = candidates[k][2 * i];
                v[k] = candidates[k][2 * i + 1];
            }
            layout.add(square(i), probe[i], u.data(), v.data(), part.values.data() + layout.size());
            for (Index e = near.offset[i]; e < near.offset[i + 1]; ++e) {
                const std::size_t j = static_cast<std::size_t>(near.vertex[e]);
                if (j < i || !core[j]) continue;
                for (int k = 0; k < count; ++k) {
                    u[k] = candidates[k][2 * i] - candidates[k][2 * j];
                    v[k] = candidates[k][2 * i + 1] - candidates[k][2 * j + 1];
                }
                layout.add(square(i) + square(j), probe[i] - probe[j], u.data(), v.data(), part.values.data());
            }
        }
        return part;
    });
    if (all.values.empty()) {
        const std::vector<double> none(layout.size(), 0);
        return {layout.risk(none.data()), layout.risk(none.data())};
    }
    return {layout.risk(all.values.data()), layout.risk(all.values.data() + layout.size())};
}

Eigen::VectorXd least_risk(const Risk& risk) {
    // Pairs of weights in turn: from the one with the steepest rise to the one with the steepest fall. The input, which
    // moves nothing, is the last.
    const Eigen::Index input = risk.linear.size();
    Eigen::MatrixXd quadratic = Eigen::MatrixXd::Zero(input + 1, input + 1);
    quadratic.topLeftCorner(input, input) = risk.quadratic;
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(input + 1), t = Eigen::VectorXd::Zero(input + 1);
    gradient.head(input) = risk.linear;
    t[input] = 1;
    constexpr int most_steps = 1000;
    for (int step = 0; step < most_steps; ++step) {
        Eigen::Index to = 0, from = -1;
        for (Eigen::Index k = 0; k <= input; ++k) {
            if (gradient[k] < gradient[to]) to = k;
            if (t[k] > 0 && (from < 0 || gradient[k] > gradient[from])) from = k;
        }
        const double slope = gradient[from] - gradient[to];
        if (!(slope > 1e-9 * risk.constant)) break;
        const double curvature = quadratic(to, to) + quadratic(from, from) - 2 * quadratic(to, from);
        const double amount = curvature > 0 ? std::min(t[from], slope / curvature) : t[from];
        t[to] += amount;
        t[from] = amount < t[from] ? t[from] - amount : 0;
        gradient += amount * (quadratic.col(to) - quadratic.col(from));
    }
    return t.head(input);
}

}  // namespace multires
