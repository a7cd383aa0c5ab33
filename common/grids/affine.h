#pragma once

#include "grids/raster.h"

namespace multires {

/// An affine function of lattice coordinates.
struct Affine {
    double middle = 0, along_i = 0, along_j = 0;  ///< its value at the mean of the samples' places, and its slopes
};

/// The affine functions nearest to samples of a mask, by least squares. Every scaling function reproduces them: what
/// is left of a plane is nothing, up to its outline. A single row of points has no slope across.
class AffineFit {
public:
    /// @param mask  at least one sample
    explicit AffineFit(const Mask& mask);

    /// Samples that are all equal give their value and no slope, exactly. Cost: linear.
    Affine of(const Mask& mask, const Raster& samples) const;
    double at(const Affine& a, double i, double j) const {
        return a.middle + (i - mean_i_) * a.along_i + (j - mean_j_) * a.along_j;
    }

private:
    double mean_i_ = 0, mean_j_ = 0, ii_ = 0, ij_ = 0, jj_ = 0, count_ = 0;
};

}  // namespace multires
