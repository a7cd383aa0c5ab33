#pragma once

#include "filters/filter.h"

namespace multires {

/// Where the texture coordinates of the coarse level come from.
enum class Projection {
    cylindrical,  ///< u: angle about the axis, 0..1 once around; v: height, 0..1
    spherical,    ///< u: longitude, 0..1 once around; v: latitude, 0 and 1 at the poles
    planar,       ///< u, v: position in the plane across the axis, the longer side 0..1
    existing,     ///< the vertices' own texture coordinates
};

/// The axis of a projection, through the centroid of the surface.
enum class ProjectionAxis {
    principal,  ///< along the longest extent (planar: the shortest), by the second moments of the surface
    x,
    y,
    z,
};

/// Texture coordinates from a coarse level by subdivision (Guskov et al. 1999, section 4.3): the vertices of the level
/// get coordinates by a projection, and those of all finer levels come from the pyramid's subdivision of these with no
/// details, so that they vary smoothly over the surface however rough its geometry is.
///
/// Angles jump at a seam and so cannot be subdivided. What is subdivided is continuous: for a cylinder the cosine and
/// the sine of the angle and the height, for a sphere the direction; the angle is taken at the end. Vertices get u in
/// [0, 1). The faces' corners (wedges) get u without jumps: where a face crosses the seam, u goes on beyond 1, so that
/// no face shows the picture backwards. A corner at a pole, which has no angle, gets the mean of the other two. A face
/// with a pole inside cannot be mapped without a fold; the report counts them.
struct TexcoordOptions {
    Projection projection = Projection::cylindrical;
    ProjectionAxis axis = ProjectionAxis::principal;  ///< not for existing coordinates
    int coarse_vertices = 1000;                       ///< >= 1: the first level with so many or fewer, or the base
    PyramidOptions pyramid;
};

/// @returns  vertex and wedge texture coordinates. Wedges keep the index of their texture, or get 0.
/// @throws InputError  for options out of range, meshes that are not usable, `existing` without vertex texture
///                     coordinates or with some that are not finite
/// Cost: building the pyramid, unless it is kept; then O(V + F).
Result generate_texcoord(const Layer& layer, const TexcoordOptions& options, Session& session);

/// The texture coordinates that exist, if they are continued (see open_where_values_differ()).
std::vector<std::size_t> kept_apart(const Layer& layer, const TexcoordOptions& options);

}  // namespace multires
