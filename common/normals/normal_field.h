#pragma once

#include "normals/face_graph.h"

#include <functional>
#include <vector>

/// Denoising of the face normals in a scale space of their own, and fitting vertices to normals.
///
/// The normals are smoothed step by step with weights that fall with distance and with the difference of normals
/// (bilateral: Zheng et al. 2011), where the tolerated difference starts wide and narrows with the noise that is left.
/// Snapshots along the way are the levels of a scale space; their differences are its details. Each detail is kept or
/// dropped locally by how its energy compares with the energy that noise alone leaves at that scale (James-Stein
/// shrinkage), which smooths flat parts long and curved parts briefly, without a parameter. Vertices then move along
/// the new normals (Sun et al. 2007).
namespace multires {

/// What a caller may say; the constants of the method stand in normal_field.cpp.
struct NormalFieldOptions {
    double strength = 1;  ///< > 0; scales the noise that is assumed
    /// Median difference of the normals of two faces with a common edge that is put down to noise; 0: measured.
    double noise = 0;
    std::vector<std::uint8_t> silent;  ///< #F: faces whose differences do not count for that; empty: none
    bool statistics = true;            ///< all of NormalFieldStats, not only the noise before
};

/// What was found and done, for the report.
struct NormalFieldStats {
    double noise = 0;                   ///< median difference of neighbouring normals (chord length) before
    double left = 0;                    ///< and after
    std::vector<double> detail_rms;     ///< of each detail, fine to coarse
    std::vector<double> noise_rms;      ///< what noise alone would leave in it
    std::vector<double> share_removed;  ///< share of the detail's energy that was dropped
};

/// Smoothed unit normals of all faces; degenerate faces (area 0) have a zero normal.
/// @param tick  called with the fraction done; may throw to stop
Array<Vec3> denoise_normals(const Faces& faces, const Positions& positions, const FaceGraph& graph,
                            const NormalFieldOptions& options, NormalFieldStats& stats,
                            const std::function<void(double)>& tick);

/// One bilateral step of the normals, of which it is made.
/// @param spatial    spatial_weights()
/// @param area       #F
/// @param n          #F: unit normals; faces without one stay so
/// @param tolerance  deviation of the weights over differences of normals
Array<Vec3> bilateral_step(const FaceGraph& graph, const std::vector<double>& spatial, const std::vector<double>& area,
                           const Array<Vec3>& n, double tolerance);

/// Whether slivers may move within the surface.
enum class Slivers { make_room, stay };

/// Moves vertices so that faces get the given normals: each goes to the mean of its projections on the planes through
/// its faces' centroids (Sun et al. 2007, eq. 8), `steps` times. Vertices of faces that are folded or nearly degenerate
/// also move within the surface, towards the middle of their ring, until they are not, unless they are to stay there.
/// @param normals  #F; zero normals have no say
/// @param moves    #V: vertices that are not to stay; empty: all
Positions fit_vertices(const Faces& faces, const Positions& positions, const Incidence& at, const Array<Vec3>& normals,
                       int steps, const std::vector<std::uint8_t>& moves = {}, Slivers slivers = Slivers::make_room);

}  // namespace multires
