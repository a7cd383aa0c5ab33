#pragma once

#include "base/progress.h"
#include "mesh/mesh.h"
#include "watermark/carriers.h"

#include <vector>

/// Reading the coefficients of carriers off a mesh, beside the original.
namespace multires {

/// What a mesh tells of the coefficients.
struct CarrierValues {
    std::vector<double> value;  ///< linear estimates of least mean square error, on the scale of the mark
    /// How much of each value is signal, in [0, 1): value = share x coefficient + noise of variance ~ share (1 -
    /// share). 0 for carriers where the mesh has nothing.
    std::vector<double> share;
    double rms_offset = 0;  ///< of the mesh from what it was compared with, mesh units of the original
    double seen = 0;        ///< share of the carriers with something to read
    double scale = 1;       ///< factor that makes the mesh as large as the original
    double smoothing = 0;   ///< of the original before it was compared, as steps that go all the way to the mean
};

/// Lays the mesh onto the original and fits its offsets along the normals by the carriers.
///
/// Smoothing changes a shape by far more than a mark. So the original is smoothed, too, by several amounts, and the
/// mesh is compared with the one that comes nearest to it. What a small rigid motion, scaling and the next smaller and
/// larger amounts explain of the offsets is taken off first. Vertices farther away than 2 % of the size are no part of
/// it; offsets beyond three deviations are cut. Knows nothing of the mesh's connectivity but the areas.
/// @param mesh  in the coordinates of the original, if it was not moved
/// Cost: 10^5 to 10^6 searches to place the mesh and one a vertex, and a system of up to 280 unknowns.
CarrierValues read_carriers(const Mesh& mesh, const Mesh& original, const Carriers& carriers, const Progress& progress);

/// A message, and how sure it is.
struct Reading {
    Message message{};
    std::vector<double> confidence;  ///< 64: the probability that the bit is right
    /// How probable so strong an agreement with a code word would be with the values at hand and a wrong key: from the
    /// mean and deviation over 500 keys, as if their distribution were normal.
    double probability_unmarked = 1;
};
Reading decode(const CarrierValues& values, const Assignment& key);

}  // namespace multires
