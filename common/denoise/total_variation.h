#pragma once

#include "denoise/neighbours.h"

#include <array>

namespace multires {

/// Total variation of values on a surface (Rudin, Osher, Fatemi 1992), several channels together: the x that minimises
///     sum over vertices |x_i - y_i|^2 / (2 s_i^2)  +  strength sum over edges |x_i - x_j| / s_ij,
/// where s is the deviation of the noise and s_ij its mean over the edge. Steps stay steps, and plain regions become
/// plain. By accelerated projected gradients on the dual (Beck, Teboulle 2009), with steps of each edge's own length
/// (Pock, Chambolle 2011).
class TotalVariation {
public:
    explicit TotalVariation(const Neighbours& near);

    /// @param values     #V by fields by width: one or two fields, each denoised by itself; width at most 4
    /// @param deviation  #V, >= 0; where it is 0 values stay
    /// @param strength   >= 0; 1 takes most of the noise of a plain region
    /// @returns          #V by fields by width
    /// Cost: 40 passes over the edges; two fields at once take much less than one after the other
    std::vector<double> denoised(const std::vector<double>& values, int width, const std::vector<double>& deviation,
                                 double strength) const;

private:
    template <int fields, int width>
    std::vector<double> denoised(const std::vector<double>& values, const std::vector<double>& deviation,
                                 double strength) const;

    const Neighbours& near_;
    std::vector<std::array<Index, 2>> edge_;  ///< #E by 2, the smaller vertex first
    std::vector<Index> edge_of_;              ///< #entries
};

}  // namespace multires
