#pragma once

#include "filters/original.h"
#include "filters/region.h"
#include "pyramid/pyramid.h"
#include "schemes/threshold.h"

namespace multires {

/// How noise is told from shape.
enum class DenoiseMethod {  // the order is that of scripts: append
    /// The scale space of the face normals, details kept where they exceed what noise leaves there: see
    /// normals/normal_field.h. Needs no parameter, takes every shape for piecewise smooth.
    normal_field,
    /// Soft thresholding of the pyramid's detail vectors (Roy et al. 2003, eq. 8).
    soft_threshold,
    /// Hard thresholding of them.
    hard_threshold,
    /// Measures the noise and chooses among low passes, local Wiener filters, the normal field and the input itself by
    /// how far from the truth each is expected to be: see denoise/automatic.h. Needs no parameter.
    automatic,
};

/// What a threshold is given in.
enum class ThresholdUnit {
    automatic,  ///< from the noise found in the mesh and the risk (denoise_threshold.h); `threshold` is not used
    length,     ///< mesh units
    percent,    ///< of the diagonal of the bounding box: 1 = 1 %
    share,      ///< thresholding: percent of the details of the levels chosen, the shortest (Szczesna 2011, Figure 13)
};

struct DenoiseOptions {
    DenoiseMethod method = DenoiseMethod::automatic;
    ThresholdUnit unit = ThresholdUnit::automatic;
    /// Length of noise, >= 0: thresholding drops details up to it; the others take it for the
    /// standard deviation.
    double threshold = 0;
    double strength = 1;       ///< >= 0; factor for the noise that is assumed, unless a threshold is given; 0: none
    int finest_level = 0;      ///< thresholding: levels finest_level .. coarsest_level - 1
    int coarsest_level = 5;    ///< (Roy: the five finest)
    bool per_level = true;     ///< thresholding, automatic: a threshold for each subband; otherwise one for all
    bool normal_only = false;  ///< thresholding: only the part of a detail along the normal
    int cycle_spins = 1;       ///< thresholding: mean over so many different hierarchies, 1..64
    bool fast = false;         ///< automatic: large meshes are measured and chosen for on a few parts of them
    bool keep_volume = false;  ///< shift along the normals until the volume is that of the input
    /// Vertex quality as confidence: 1 is trusted and stays, 0 gets the full threshold; clamped to [0, 1].
    bool confidence = false;
    Region region;
    RelativeTo relative_to = RelativeTo::current;  ///< the noise is measured there, and its volume kept
    PyramidOptions pyramid = fine_levels();        ///< for thresholding
};

/// Standard deviation of the noise along the normals, mesh units, for the normal field and given thresholds: median of
/// the second-order differences over the edges (Guskov et al. 1999, section 2.1), so that sharp edges hardly count.
/// Somewhat low where noise is as strong as the triangles are large, and an upper estimate for meshes whose shape is as
/// fine as their triangles.
double noise_deviation(const Mesh& mesh);

/// Removes noise and keeps what is shape.
/// @throws InputError as all filters, and for thresholds, levels or spins out of range
Result denoise(const Layer& layer, const DenoiseOptions& options, Session& session);

}  // namespace multires
