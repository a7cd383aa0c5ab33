#pragma once

#include "grids/box_spline.h"
#include "grids/lattice.h"

#include <cstddef>
#include <vector>

namespace multires {

/// The levels of one grid and the transforms between samples and coefficients. Knows which points there are, no values.
///
/// Level 0 is the grid, level m + 1 has half as many points along each direction, and all whose functions reach a point
/// of level m: a rim of a few around the outline and in holes. Analysis extends each level anew (extension.h), so that
/// the extension decides what coefficients are, and not whether the samples come back: they do, up to rounding.
///
/// Coefficients of a channel are one array of size(): the details of level 0 by type 1 to 7, those of level 1, ..., and
/// at the end those of the scaling functions of the last level. Those whose function reaches no point are 0.
class GridPyramid {
public:
    /// @param levels  >= 1; ends earlier where the next one would not be smaller
    GridPyramid(const Grid& grid, SplineBasis basis, int levels);

    int levels() const { return static_cast<int>(shapes_.size()) - 1; }
    SplineBasis basis() const { return basis_; }
    std::size_t size() const { return size_; }

    /// Place in an array of coefficients where a subband begins. Type 0, the scaling functions, of the last level only.
    std::size_t offset(int level, int type) const;
    /// The number of a subband's places.
    std::size_t band_size(int level) const { return shapes_[level + 1].mask.values.size(); }
    /// Points of a level; those of level m + 1 are the coefficients of level m.
    const Mask& mask(int level) const { return shapes_[level].mask; }
    /// Box of level m + 1 on level m.
    CoarseBox box(int level) const { return coarse_box(basis_, mask(level).rows, mask(level).columns); }
    /// A vertex of the mesh near each point of a level, for attributes; -1 where there is no point.
    const Array<Index>& source(int level) const { return shapes_[level].source; }
    /// Norm of the functions of a subband, on the samples of the grid: root of the sum of squares.
    double norm(int level, int type) const { return norm_[level][type]; }

    Array<double> analyse(const Raster& samples) const;
    /// Samples of level `to`, in its box.
    Raster synthesise(const Array<double>& coefficients, int to = 0) const;
    /// The transpose of synthesise(.., 0).
    Array<double> correlate(const Raster& samples) const;
    /// What scaling functions of level `from` alone give at level `to`.
    Raster refine(Raster samples, int from, int to) const;

private:
    struct Shape {
        Mask mask;
        Array<Index> source;
    };
    void add_level();
    void measure_norms();
    void store(int level, const std::array<Raster, subbands>& bands, Array<double>& to) const;

    SplineBasis basis_;
    std::vector<Shape> shapes_;
    std::vector<std::array<double, subbands>> norm_;
    std::size_t size_ = 0;
};

/// Levels down to about 4 by 4 points, at least one.
int usual_levels(const Grid& grid);

/// What scaling functions alone give at the next finer level: one step of subdivision.
/// @param rows, columns  of the finer level; `coarse` has the size of its coarse_box()
Raster subdivided(const Raster& coarse, SplineBasis basis, Index rows, Index columns);

}  // namespace multires
