#pragma once

#include "denoise/along_normals.h"

/// Whether the edges of a mesh know its details. Who makes a coarse mesh of a shape, be it simplification, remeshing or
/// a person, lays the edges along its bends, so that turning one within its two faces bends the surface more. Noise
/// that is added afterwards does not know the edges. So they tell apart what no spectrum does: where features are as
/// small as triangles they are as white as noise.
namespace multires {

/// How much more the surface would bend if edges were turned: over a sample of the edges, the difference of the total
/// absolute mean curvature (lengths by angles between normals) of the five edges around two faces with the common edge
/// turned and as it is, by their sum (Dyn, Hormann, Kim, Levin 2001: the cost of a triangulation). Edges on rims, of
/// other than two faces, and those that cannot be turned without folding do not count. In [-1, 1]; 0 without edges.
/// Cost: O(#F log #F), once; then of the sample
class EdgeFit {
public:
    explicit EdgeFit(const Faces& faces);
    double of(const Positions& positions) const;

private:
    /// Two faces (a, b, c) and (b, a, d), and the vertices across their other edges; -1: none.
    struct Pair {
        Index a, b, c, d;
        Index across_bc, across_ca, across_ad, across_db;
    };
    std::vector<Pair> pairs_;
};

/// The share of the square of what looks like white noise that is noise: the less the more the edges suit the surface
/// beyond what they suit the smoothed surface with noise of the same deviation, the mean over samples.
/// @param deviation  #V: of what looks like noise along the normals, mesh units
/// @returns          in [0, 1]; 1 where the edges suit the surface as they suit noise
/// Cost: linear, but for EdgeFit
double share_of_noise_by_edges(const Faces& faces, const Positions& positions, const Neighbours& near,
                               const std::vector<double>& deviation);

}  // namespace multires
