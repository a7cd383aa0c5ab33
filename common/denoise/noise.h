#pragma once

#include "denoise/axis_noise.h"

namespace multires {

/// Deviations: Gaussian noise moves one vertex in 16,000 farther.
constexpr double farthest_by_noise = 4;

/// White noise on a surface.
struct SurfaceNoise {
    double along_normals = 0;  ///< standard deviation of the part along the normals, mesh units
    /// What it is at least, mesh units: details that are not taken for noise elsewhere, and details that stand out
    /// of those around them as noise does not, tell how far shape may have been taken for noise. If it is strong, the
    /// quietest three tenths of the surface are enough to tell.
    double at_least = 0;
    /// Share of the square that is white noise if the rest is a rough surface: see white_share(). Creases make it less.
    double white = 1;
    /// Share of the square of what looks like it that is noise by how the edges suit it, see edge_fit.h: the rest is
    /// shape, and left out above.
    double by_edges = 1;
    /// Of the vertices' places within the surface in each of two directions, mesh units: an upper bound of the noise
    /// there, for an irregular sampling looks the same.
    double within_surface = 0;
    bool all_directions = false;  ///< it is known to go in all directions
    bool maybe_all = false;       ///< the vertices' places within the surface do not speak against that
    bool likely_all = false;      ///< they are just as irregular as the noise would make them
    bool surely_all = false;      ///< the same, up to where they are most irregular
    /// Beside the former two, which are what there is of it in all directions.
    std::optional<AxisNoise> axis;

    /// Along normals of this direction.
    double along(const Vec3& normal) const;
};

/// Estimates the noise from third differences along smoothed normals, in units of what white noise of deviation 1
/// makes of the same differences on the same mesh (energies.h), in two ways:
/// - Noise is everywhere, texture and creases are not: the lowest tenth of the energies counts, less what the spread
///   from there to the third tenth says of texture.
/// - Shape has details where it bends: the part of the energies counts that does not go with the bends.
/// If both agree it is the second, which uses all vertices, otherwise the smaller. Weak noise is the root mean square
/// of that and of fifth differences less what falls from third to fifth ones, which is shape.
///
/// Noise along one axis is looked for as well (axis_noise.h). Other noise that is not the same everywhere is
/// underestimated: its quietest part counts.
/// @param edge  mean edge length
/// Cost: linear, about 120 passes over the neighbours
SurfaceNoise surface_noise(const Faces& faces, const Positions& positions, const Incidence& at, const Neighbours& near,
                           double edge);

/// The same of noise that varies: sets what the vertices' places within the surface say.
/// @param deviation  #V: along the normals, mesh units
/// @param noise      its `along_normals` is their root mean square, > 0
void find_varying_within_surface(const Faces& faces, const Positions& positions, const Neighbours& near,
                                 const std::vector<double>& deviation, SurfaceNoise& noise);

/// Of rounding coordinates to a lattice of this step: uniform errors. Nothing unless third differences have a fair
/// share of what those make nearly everywhere: a shape may have been designed on a lattice. Creases and details may
/// have more.
/// @param even  #V: EvenPlaces::silent, which do not count
std::optional<SurfaceNoise> rounding_noise(const Faces& faces, const Positions& positions, const Incidence& at,
                                           const Neighbours& near, const std::vector<std::uint8_t>& even, double step,
                                           double edge);

}  // namespace multires
