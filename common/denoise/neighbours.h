#pragma once

#include "normals/face_graph.h"

#include <cstdint>
#include <vector>

namespace multires {

/// Vertices with a common edge, in compressed rows; any mesh has them, manifold or not.
struct Neighbours {
    std::vector<Index> offset{0};   ///< #V+1
    std::vector<Index> vertex;      ///< #entries, ascending within a row
    std::vector<std::uint8_t> rim;  ///< #V: 1 where an edge has other than two faces

    Index rows() const { return static_cast<Index>(rim.size()); }
    Index size(Index v) const { return offset[v + 1] - offset[v]; }
};

/// Cost: O(d log d) for a vertex of valence d; parallel.
Neighbours neighbours(const Faces& faces, const Incidence& at);

/// More neighbours than surfaces have, but at poles.
constexpr Index most_around = 64;
/// Vertices up to two edges away, ascending, itself not among them. What lies behind a vertex with more than
/// most_around neighbours, around which nearly all would be, is left out.
void two_rings(const Neighbours& near, Index v, std::vector<Index>& ring);

/// Weights of the entries: the cotangents of the angles opposite to each edge, limited to [0.05, 5], so that they are
/// positive on slivers too; every row sums to 1.
/// @returns  #entries
std::vector<double> cotangent_weights(const Faces& faces, const Incidence& at, const Neighbours& near,
                                      const Positions& positions);

/// Taubin's low pass with equal weights (1995; 0.5 and -0.53): `steps` pairs of one step inwards and one outwards.
Positions taubin(const Neighbours& near, Positions positions, int steps);
/// Fields of vectors, in columns.
template <int count>
using Columns = Eigen::Matrix<double, 3, count>;
/// The same with 0.5 and -0.5, as AlongNormals::smooth() does, of one, two or three fields at once: three take two
/// thirds of the time.
template <int count>
Array<Columns<count>> smoothed_fields(const Neighbours& near, Array<Columns<count>> fields, int steps);

/// Detail of vectors: each less the mean of its neighbours.
Positions detail_of(const Neighbours& near, const Positions& p);

/// Replaces each value by its mean with the neighbours' values, `steps` times.
/// @param values  #V by `width`, interleaved; width is 1, 2, 3 or 6
void average(const Neighbours& near, std::vector<double>& values, int width, int steps);

/// A sample of the standard normal distribution: the same for the same place and seed.
double gaussian(Index place, std::uint64_t seed);

}  // namespace multires
