#pragma once

#include "denoise/neighbours.h"
#include "mesh/mesh.h"

namespace multires {

/// White noise from differences of first and third order, of something on a surface and of two samples of noise of
/// deviation 1, compared by quantiles of their lengths.
class NoiseByDifferences {
public:
    /// @param first, third  #V by 3: differences of what is measured, of noise, of other noise
    NoiseByDifferences(const Neighbours& near, const std::vector<double>& first, const std::vector<double>& third);

    /// What some vertices tell.
    struct Found {
        double quiet = 0;    ///< deviation by the quieter part of them
        double noise = 0;    ///< as much of it as the distribution of the differences allows
        bool white = false;  ///< first differences are about as large as third ones
    };
    /// The quieter part of the vertices gives the deviation, because edges and textured places only add to it; what
    /// first differences have more is shape, of which a share is taken off; and no more is believed than the
    /// distribution of the third differences allows. Vertices on a rim count if there are no others.
    /// @param quiet  quantile of the lengths that counts
    Found at(std::vector<Index> vertices, double quiet) const;

    /// The deviation at each vertex, where it varies: measured in cells of several hundred vertices, then followed
    /// within them by means of the third differences around each vertex, clipped. A cell has more than the others only
    /// if its details are about white; otherwise it is texture.
    /// @param everywhere  deviation by all vertices: what texture has if no cell is white
    /// @param least       standard deviation of the cells' deviations over their mean; if it is less, they differ by
    ///                    chance
    /// @returns           #V, or nothing if the cells differ by chance, are too few, or some of them have hardly any
    std::vector<double> varying(const Positions& positions, double everywhere, double least) const;

private:
    /// Lengths over what the mesh makes of noise locally, #V by 3; negative where that is nothing.
    std::vector<double> lengths(const std::vector<double>& differences) const;
    double ratio(const std::vector<double>& length, const std::vector<Index>& vertices, double share) const;
    std::vector<double> refined(const std::vector<double>& deviation, const std::vector<std::uint8_t>& follows) const;

    const Neighbours& near_;
    std::vector<double> first_, third_;
};

}  // namespace multires
