#include "schemes/sure.h"

namespace multires {
namespace {

/// Lengths in ascending order, in deviations of the noise.
struct LevelDetails {
    std::vector<double> lengths;
    double width = 1;

    double count() const { return static_cast<double>(lengths.size()); }
};

/// Pure noise hardly ever exceeds it.
double universal(const LevelDetails& d) {
    return std::sqrt(d.width - 1) + std::sqrt(2 * std::log(std::max(2.0, d.count())));
}

/// True if the details are no longer than noise makes them, as far as can be told: to two deviations of their energy.
bool nothing_but_noise(const LevelDetails& d) {
    double squares = 0;
    for (const double l : d.lengths) squares += l * l;
    const double all = d.count() * d.width;
    return squares / all - 1 <= 2 * std::sqrt(2 / all);
}

double least_soft(const LevelDetails& d, double most) {
    double inverse = 0;  // sum of 1 / |d| above the threshold
    for (const double l : d.lengths)
        if (l > 0) inverse += 1 / l;
    double best = 0, threshold = 0, below = 0, squares = 0;  // risks less that of 0
    for (const double t : d.lengths) {
        if (t > most) break;
        ++below, squares += t * t;
        if (t > 0) inverse -= 1 / t;
        const double risk =
            squares + (d.count() - below) * t * t - 2 * (d.width * below + (d.width - 1) * t * std::max(0.0, inverse));
        if (risk < best) best = risk, threshold = t;
    }
    return threshold;
}

double least_hard(const LevelDetails& d, double most) {
    constexpr double step = 0.1, window = 0.5;
    const auto up_to = [&](double t) {
        return static_cast<double>(std::upper_bound(d.lengths.begin(), d.lengths.end(), t) - d.lengths.begin());
    };
    double best = 0, threshold = 0, squares = 0;
    auto next = d.lengths.begin();
    for (double t = step; t <= most; t += step) {
        for (; next != d.lengths.end() && *next <= t; ++next) squares += *next * *next;
        const double density = (up_to(t + window) - up_to(t - window)) / (2 * window);
        const double risk = squares - 2 * (d.width * up_to(t) - t * density);
        if (risk < best) best = risk, threshold = t;
    }
    return threshold;
}

}  // namespace

double sure_threshold(std::vector<double> lengths, int width, double deviation, Shrink rule) {
    if (lengths.empty() || !(deviation > 0)) return 0;
    LevelDetails d{std::move(lengths), static_cast<double>(width)};
    for (double& l : d.lengths) l /= deviation;
    const double most = universal(d);
    if (nothing_but_noise(d)) return deviation * most;
    std::sort(d.lengths.begin(), d.lengths.end());
    return deviation * (rule == Shrink::soft ? least_soft(d, most) : least_hard(d, most));
}

}  // namespace multires
