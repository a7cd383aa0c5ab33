#pragma once

#include <array>
#include <vector>

namespace multires {

/// Classes of vertices by the noise they have, that pass smoothly into each other: what is right for one need not be
/// for another, and a blend by their shares has no seams where the noise has none.
class NoiseClasses {
public:
    /// @param deviation  #V: of the noise; classes are at quantiles of it, one where it is about the same everywhere
    explicit NoiseClasses(std::vector<double> deviation);

    std::size_t count() const { return at_.size(); }
    /// Shares of the classes in a vertex of that deviation; they sum to 1.
    std::array<double, 3> shares(double deviation) const;

private:
    std::vector<double> at_;  ///< logarithms of deviations, ascending
};

}  // namespace multires
