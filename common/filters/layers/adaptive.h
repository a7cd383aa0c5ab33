#pragma once

#include "filters/filter.h"
#include "hierarchy/refinement.h"
#include "pyramid/band.h"

/// Threshold reconstruction (Roy et al. 2003, section 4.3): the vertices whose detail is long enough, and all they
/// depend on.
namespace multires {

/// What a vertex's geometric detail is.
enum class Criterion {
    /// What removing the vertex adds to the RMS distance, given as the distance by which a neighbourhood of average
    /// size would have to be off to add the same. Gives the smallest RMS distance for a number of faces.
    area_error,
    /// RMS distance between the vertex it is collapsed into and the planes of the input around the vertex, whatever
    /// their area: keeps small features.
    local_error,
    /// Length of the pyramid's detail (Roy): distance to where the relaxation operator predicts the vertex.
    detail,
};

/// How the threshold is found.
enum class Target {
    threshold,         ///< as given
    faces,             ///< the most vertices that give at most so many faces
    vertices,          ///< so many vertices
    rms_distance,      ///< the fewest vertices found whose two-sided RMS distance is within a bound
    largest_distance,  ///< the same for the largest distance
};

enum class LengthUnit { mesh, percent };  ///< percent: of the diagonal of the bounding box, 1 = 1 %

/// One attribute's part in the choice of vertices.
struct DetailThreshold {
    bool use = false;
    double threshold = 0;  ///< >= 0; details of at least this length are kept
};

struct AdaptiveOptions {
    Target target = Target::threshold;
    LengthUnit unit = LengthUnit::percent;  ///< of geometry.threshold and error
    DetailThreshold geometry{true, 0.05};   ///< in `unit`
    DetailThreshold color{false, 16};       ///< length of (r, g, b, a) in 0..255
    DetailThreshold quality{false, 1};      ///< in the measure of the quality
    DetailThreshold texcoord{false, 0.01};  ///< length of (u, v); of corners where they may differ, else of vertices
    DetailThreshold normal{false, 10};      ///< degrees
    int faces = 1000;                       ///< >= 0, for Target::faces
    int vertices = 500;                     ///< >= 0, for Target::vertices; unreferenced ones are not counted
    double error = 0.1;                     ///< > 0, in `unit`, for the distance targets
    Criterion criterion = Criterion::area_error;
    Operator op = Operator::cotangent_delaunay;  ///< predicts attributes, and positions for Criterion::detail
    bool region_of_interest = false;             ///< selected vertices and faces are kept whatever their details
    bool fit = false;  ///< move the vertices kept to where they fit the input best, see also moves_on_the_way()
    /// Gain of a band of details, applied to the input before anything else; 1: none.
    double band_gain = 1;
    Band band;
    PyramidOptions band_pyramid;  ///< of the band
    bool measure = true;          ///< report the distance to the input
    int base_vertices = 100;      ///< >= 4
    double normal_limit = 60;     ///< degrees, in (0, 180]; see HierarchyOptions
    Features features = Features::none;
    double feature_angle = 40;  ///< degrees, for Features::angle
};

/// The mesh of a threshold as a new layer: vertices and faces in order of the input.
///
/// With several attributes in use a vertex is kept if any of its details reaches its threshold; for the targets the
/// thresholds are scaled together. Any mesh of a lower threshold holds the vertices of one of a higher threshold;
/// threshold 0 is the input, one above everything the base. Unreferenced vertices are always kept.
/// @throws InputError  for unusable meshes, options out of range, attributes the layer does not have, or a region of
///                     interest without a selection
Result adaptive_reconstruction(const Layer& layer, const AdaptiveOptions& options, Session& session);

constexpr double boundary_weight = 3;  ///< of the boundary in costs and geometric details

/// Rings of the layer, with features marked. With use_texcoord, seams of the texture are features, too: vertices on
/// them go only along them.
Rings adaptive_rings(const Layer& layer, const AdaptiveOptions& options);

/// The hierarchy adaptive reconstruction uses: memoryless costs, small sets. Has no even rings.
/// @param rings  adaptive_rings()
Hierarchy adaptive_hierarchy(const Layer& layer, Rings rings, const AdaptiveOptions& options, const Progress& progress);

/// How much each vertex matters, by place: largest ratio of a detail and its threshold, infinity for a threshold of 0
/// and in the region of interest. See adaptive_importance.cpp.
/// @param rings  adaptive_rings()
std::vector<double> importance(const Layer& layer, const Rings& rings, const Hierarchy& hierarchy,
                               const AdaptiveOptions& options);

/// Moves the vertices of a reconstruction to where they fit the input better: least squares of the distances of the
/// centroids of the input's faces, by area, along the normals of faces near them (Hoppe et al. 1993, "Mesh
/// Optimization", section 4.1, has such samples and closest points; here one pass of four damped steps, in which each
/// vertex is by itself). No face turns by more than 60 degrees against where it was; vertices without a closed ring
/// stay (boundary, non-manifold, in no face), as do those marked `fixed`. See adaptive_fit.cpp.
/// @param positions  #V', of the vertices that `faces` refers to
/// @param into       #V of the input: the vertex of the reconstruction each went into, or is
/// @param fixed      #V'
/// Cost: linear in the faces of both.
Positions fitted(const Mesh& input, const Faces& faces, const Positions& positions, const std::vector<Index>& into,
                 const std::vector<std::uint8_t>& fixed);

}  // namespace multires
