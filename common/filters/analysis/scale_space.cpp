#include "filters/analysis/scale_space.h"

#include "base/angles.h"

#include <algorithm>
#include <cmath>

namespace multires {

Chain::Chain(const std::vector<double>& cutoffs) {
    for (std::size_t b = 0; b < cutoffs.size(); ++b) {
        const double before = b == 0 ? 1 : transmission(b - 1, cutoffs[b]);
        widths_.push_back(cutoffs[b] * std::sqrt(std::max(0.0, 2 * before - 1)));
    }
}

double Chain::transmission(std::size_t b, double wave) const {
    double left = 1;
    for (std::size_t j = 0; j <= b; ++j) left /= 1 + (widths_[j] / wave) * (widths_[j] / wave);
    return left;
}

void for_each_low_pass(const Spline& spline, const Mesh& mesh, const std::vector<double>& cutoffs, double tolerance,
                       const Progress& progress, const std::function<void(std::size_t, const Positions&)>& visit) {
    const Chain chain(cutoffs);
    const System& system = spline.solver();
    Positions low = mesh.positions, next(low.size());
    SolveMemory memory;
    SolveOptions options;
    options.memory = &memory;
    options.tolerance = tolerance;
    options.together = true;  // so that a turned mesh gives the same, turned
    for (std::size_t b = 0; b < cutoffs.size(); ++b) {
        const double share = 1 / static_cast<double>(cutoffs.size()), begin = share * static_cast<double>(b);
        const double k = 2 * pi / chain.widths()[b];
        system.rational(terms(LowPassOrder::first), 1 / (k * k), low, next, options,
                        progress.part(begin, begin + share));
        low.swap(next);
        visit(b, low);
    }
}

}  // namespace multires
