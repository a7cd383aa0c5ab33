#pragma once

#include "base/progress.h"
#include "hierarchy/hierarchy.h"
#include "mesh/layer.h"
#include "mesh/shape_hash.h"
#include "schemes/burt_adelson.h"

namespace multires {

/// Where feature edges come from; they are not smoothed across.
enum class Features {
    none,
    angle,           ///< edges where the faces' normals differ by more than an angle
    non_faux_edges,  ///< edges that are not faux, as MeshLab's crease filter leaves them
    selected_edges,  ///< edges selected on their faces
};

/// How a pyramid is built. The defaults give the sharpest bands.
struct PyramidOptions {
    Scheme scheme = Scheme::guskov;
    Operator op = Operator::second_difference_flaps;
    double presmooth = 0.5;  ///< share of the relaxation applied before subsampling, in [0, 1]
    Grouping grouping = Grouping::independent_sets;
    int sets_per_level = 2;           ///< >= 1, for independent sets
    double level_ratio = 0;           ///< in [0, 1), for sequential; 0: one vertex per level
    int base_vertices = 100;          ///< >= 4
    double length_weight = 0.1;       ///< >= 0, see HierarchyOptions
    double normal_limit = 60;         ///< degrees, in (0, 180]
    Storage storage = Storage::wide;  ///< of weights and details
    int seed = 0;                     ///< 0: cheapest collapses first; others vary the order, for averaging
    Features features = Features::none;
    double feature_angle = 40;  ///< degrees, in (0, 180), for Features::angle
};

/// @throws InputError naming the option that is out of range
void check(const PyramidOptions& options);

/// With one set per level, for thresholding: more levels see more of the noise, and 5 to 12 % less of it is left.
inline PyramidOptions fine_levels() {
    PyramidOptions options;
    options.sets_per_level = 1;
    return options;
}

/// Numbers of one level. Level 0 is the input.
struct LevelInfo {
    Index vertices = 0;     ///< isolated ones not counted
    double wavelength = 0;  ///< 2 x mean edge length of the level's mesh, mesh units: the finest wave it can carry
    double rms_detail = 0;  ///< root mean square length of the details between it and the next, mesh units
};

/// A pyramid and the mesh it belongs to. Immutable, so that filters and layers can share it.
class KeptPyramid {
public:
    KeptPyramid(const Layer& layer, const PyramidOptions& options, const Progress& progress);

    /// Without positions: place p is vertex order[p] of the layer.
    const Hierarchy& hierarchy() const { return hierarchy_; }
    const Transform& transform() const { return *transform_; }
    const Coefficients& coefficients() const { return coefficients_; }  ///< see widened()
    /// Levels 0..L: one more than there are sets of details; the last is the base.
    const std::vector<LevelInfo>& levels() const { return levels_; }
    const ContentHash& hash() const { return hash_; }

    /// Largest distance between the input's vertices and what synthesis without any gain gives, mesh units.
    /// @param positions  of the layer
    double reconstruction_error(const Positions& positions) const;

    /// Positions with the details of each level multiplied by a gain, in order of the input.
    Positions synthesise(const std::vector<double>& gain) const;

private:
    ContentHash hash_;
    Hierarchy hierarchy_;
    std::unique_ptr<Transform> transform_;
    Coefficients coefficients_;
    std::vector<LevelInfo> levels_;
};

/// Hash of all a pyramid depends on: positions, faces, options, and the edges that are features.
ContentHash content_hash(const Layer& layer, const PyramidOptions& options);

/// Marks the feature edges of a layer in its rings.
/// @throws InputError if the layer has none of the marks asked for, or the angle is out of range
void mark_features(Rings& rings, const Layer& layer, Features features, double angle);

}  // namespace multires
