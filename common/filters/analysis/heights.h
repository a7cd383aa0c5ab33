#pragma once

#include "filters/analysis/form.h"
#include "filters/filter.h"

#include <vector>

/// Heights of a texture over the surface it lies on.
namespace multires {

/// A scalar over a surface without the texture.
struct Heights {
    Mesh reference;              ///< the faces that count, and the foot of each vertex
    std::vector<double> height;  ///< #V of `reference`, mesh units, positive on the side the faces look to
};

/// A third of the area of the faces around each vertex, square mesh units; faces without an area count for nothing.
/// @returns  #V
std::vector<double> vertex_areas(const Mesh& mesh);

/// ISO 25178-2 height and hybrid parameters of heights, as mesh units, ratios, and percent (sdr), by the area of the
/// reference. Heights count from their mean; slopes are those of linear functions on the faces.
struct Texture {
    double area = 0;  ///< of the reference, square mesh units
    double mean = 0;  ///< of the heights, before it is taken off
    double sa = 0, sq = 0, sp = 0, sv = 0, sz = 0, ssk = 0, sku = 0, sdq = 0, sdr = 0;
    std::vector<double> limits;  ///< bins + 1: heights, evenly spaced from the lowest to the highest
    std::vector<double> shares;  ///< bins: of the area, with heights between two limits; sum to 1
};

/// @param bins  at least 1
/// Cost: linear. Same bits for any number of threads.
Texture texture_of(const Heights& heights, int bins);

}  // namespace multires
