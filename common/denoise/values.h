#pragma once

#include "denoise/total_variation.h"
#include "mesh/mesh.h"

#include <functional>

/// Denoising of values on a surface (colours, qualities), without a parameter, as denoise_automatic() does it for the
/// surface itself: the noise is measured, and what is done has the least estimated risk.
namespace multires {

/// A surface with what all values on it share.
struct ValueSurface {
    const Faces& faces;
    const Positions& positions;
    Neighbours near;
    std::vector<double> weight;  ///< #entries: cotangent_weights()
    Positions normal;            ///< #V by 3
    std::vector<double> bend;    ///< #V: length of the Laplacian of the places along the normal
    TotalVariation variation;

    /// The mesh must live as long.
    explicit ValueSurface(const Mesh& mesh);

private:
    ValueSurface(const Mesh& mesh, const Incidence& at);
};

struct DenoisedValues {
    std::vector<double> values;  ///< #V by width
    std::vector<double> noise;   ///< #width: deviation found, RMS over the vertices, of what is not impulses
    double smallest_noise = 0;   ///< at a vertex, of the largest, where it varies; RMS over the channels
    double largest_noise = 0;
    std::size_t impulses = 0;              ///< vertices whose values were replaced
    double step = 0;                       ///< that values were rounded to, if that is what the noise is
    double rms_before = 0, rms_after = 0;  ///< expected distance from the truth, RMS over vertices and channels
    double low_pass = 0, wiener = 0, total_variation = 0;  ///< weights in the result, mean over the channels
};

/// 1. Impulses are replaced (value_impulses.h).
/// 2. The noise is measured, channel by channel and, where it varies, at each vertex (field_noise.h).
/// 3. Low passes, local Wiener filters and total variation are made (value_candidates.h).
/// 4. Of each channel the convex blend of these and the input with the least estimated risk is taken (risk.h), if it is
///    clearly nearer to the truth than the input. Of large meshes it is chosen on patches.
/// @param values    #V by width, width at most 4, finite
/// @param strength  >= 0; factor for the noise, 0 changes nothing
/// @param rounding  no less than this is taken for noise
/// @param tick      called with the fraction done; may throw to stop
/// Cost: linear; about 1,500 passes over the neighbours, three times
DenoisedValues denoise_values(const ValueSurface& surface, const std::vector<double>& values, int width,
                              double strength, double rounding, const std::function<void(double)>& tick);

}  // namespace multires
