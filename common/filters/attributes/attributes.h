#pragma once

#include "filters/channels.h"
#include "filters/region.h"
#include "pyramid/pyramid.h"

namespace multires {

/// Relaxation of attributes by weights from the geometry (Roy et al. 2003, section 2.2, eq. 3): one step takes a value
/// f at vertex i to f_i + strength w_i (R f_i - f_i), where R is the operator and w the region's weight: vertices left
/// out keep their values all the while, and those beside them relax towards those.
///
/// Values are computed in floating point from the first step to the last. A constant stays exactly as it is, whatever
/// the operator; with operators that reproduce linear functions, a linear function over a planar mesh stays as it is up
/// to rounding; with weights in [0, 1] (umbrella, clamped and Delaunay cotangents) no value leaves the range of the
/// values around it.
///
/// Kept as they are: vertices without a ring (non-manifold, isolated), feature corners (see operators/relaxation.h),
/// and boundary vertices where the boundary turns by more than `corner_angle`: elsewhere a boundary vertex is relaxed
/// along the boundary, but no mean of its neighbours along it could give back a linear function at a corner.
///
/// Texture coordinates are relaxed chart by chart. Corners that share a vertex and a texture coordinate are one node
/// and stay together, so that a mapping that was closed stays closed; and a node is relaxed from nodes of its own chart
/// only. The nodes on the outline of a chart (seams and boundaries) are kept as they are unless keep_outline is off:
/// the picture was painted for that outline and the charts were packed by it. With keep_outline off they are relaxed
/// along the outline, on both sides of a seam by the same weights, except where the seam branches, ends or turns by
/// more than corner_angle.
struct AttributeRelaxationOptions {
    AttributeChoice what;
    Operator op = Operator::cotangent_delaunay;
    int iterations = 1;         ///< >= 1
    double strength = 1;        ///< share of each step that is taken, in (0, 1]
    double corner_angle = 45;   ///< degrees, in [0, 180]
    bool keep_outline = true;   ///< of texture charts
    bool linear_light = false;  ///< average amounts of light instead of the colour values as stored
    Region region;
    Features features = Features::none;
    double feature_angle = 40;  ///< degrees, for Features::angle
};

/// @throws InputError  for options out of range, attributes that are missing or not finite (see vertex_channels), and
///                     meshes that are not usable
/// Cost: O((V + F) iterations).
Result relax_attributes(const Layer& layer, const AttributeRelaxationOptions& options, Session& session);

}  // namespace multires
