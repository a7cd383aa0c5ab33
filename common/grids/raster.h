#pragma once

#include "base/array.h"
#include "base/index.h"

#include <cstdint>

namespace multires {

/// Numbers at the points (i, j) of a parallelogram of the lattice, at place i columns + j.
template <class T>
struct RasterOf {
    Index rows = 0, columns = 0;
    Array<T> values;

    RasterOf() = default;
    RasterOf(Index r, Index c, T value) : rows(r), columns(c), values(static_cast<std::size_t>(r) * c, value) {}

    T* row(Index i) { return values.data() + static_cast<std::size_t>(i) * columns; }
    const T* row(Index i) const { return values.data() + static_cast<std::size_t>(i) * columns; }
};
using Raster = RasterOf<double>;
using Mask = RasterOf<std::uint8_t>;  ///< 1 where there is a sample

/// Sets what is where there is no sample to 0.
inline void clear_outside(const Mask& mask, Raster& raster) {
    for (std::size_t p = 0; p < raster.values.size(); ++p)
        if (!mask.values[p]) raster.values[p] = 0;
}

}  // namespace multires
