#pragma once

#include "bands/spline.h"

#include <functional>
#include <vector>

/// Low passes at many cutoffs, each made from the one before.
namespace multires {

/// A chain of membranes: low pass b is low pass b - 1 and one more 1 / (1 + (width / wave)^2), with the width that
/// makes the whole leave half of a wave as long as cutoff b. The first is the spline filter of order 1; with more
/// stages the product nears a Gaussian of the same cutoff, because the widths are those of a diffusion.
class Chain {
public:
    /// @param cutoffs  ascending, > 0
    explicit Chain(const std::vector<double>& cutoffs);

    const std::vector<double>& widths() const { return widths_; }
    /// The share of a wave that low pass `b` leaves.
    double transmission(std::size_t b, double wave) const;

private:
    std::vector<double> widths_;
};

/// Low passes of the positions, one at a time: visit(b, low), finest first. Each is one real solve that starts from the
/// one before, so its residual is the band between the two, of which `tolerance` may be wrong.
/// @param cutoffs  ascending, at least two mean edges of the spline's mesh
/// @param visit    gets the positions, #V by 3; they are used again for the next
/// Cost: at 1e-3 three to four steps of conjugate gradients a cutoff, a fifth of Spline::low_pass. Same bits for any
/// number of threads.
void for_each_low_pass(const Spline& spline, const Mesh& mesh, const std::vector<double>& cutoffs, double tolerance,
                       const Progress& progress, const std::function<void(std::size_t, const Positions&)>& visit);

}  // namespace multires
