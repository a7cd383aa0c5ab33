#pragma once

#include "bands/spline.h"
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

/// A limit of a band, and the parameter to blame for it.
struct NamedLimit {
    double wavelength = 0;  ///< mesh units; 0 as the fine limit: none
    const char* parameter = "";
};

struct TextureBand {
    LowPassOrder order = LowPassOrder::gaussian;
    NamedLimit finest, coarsest;
    bool robust = false;  ///< the low pass at the coarse limit does not give way to what is cut or raised
};

/// Heights of the low pass at `finest` over that at `coarsest`, along the normals of the latter.
///
/// The metric of a rough surface is that of its flanks, which makes waves longer than they are seen from afar. So the
/// low passes are taken twice, the second time with the metric of what the vertices stand on after the first. If the
/// band is robust, robust_base() of the heights is then taken off them (analysis/robust_heights.h).
/// @param spline  of the mesh
/// @throws InputError  as Spline::low_pass
Heights heights_over_low_pass(const Spline& spline, const Mesh& mesh, const TextureBand& band,
                              const Progress& progress);

/// Length of the way along edges to the nearest vertex of an open rim, mesh units; what is beyond `most` may be
/// infinite. Cost: O(n log n) for the n vertices within that.
/// @returns  #V
std::vector<double> distance_from_rim(const Mesh& mesh, double most);

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
