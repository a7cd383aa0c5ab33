#pragma once

#include "filters/filter.h"

namespace multires {

enum class FeatureSelection { edges, vertices };

struct FeatureLineOptions {
    double strong = 30;  ///< degrees, in (0, 180): lines start at edges that bend by as much at every scale
    double weak = 15;    ///< degrees, in (0, strong]: and go on along edges that bend by as much
    int shortest = 6;    ///< edges: shorter branches and lines are left out; gaps of up to half of it are closed
    FeatureSelection select = FeatureSelection::edges;
};

/// Selects the lines along which a surface is sharp at every scale, after Hubeli and Gross 2001 (weights of edges,
/// hysteresis, thinning), with scales of the normal field in place of their progressive mesh: an edge weighs as much as
/// the least of the angles between
/// - the normals of its two faces, denoised (normals/normal_field.h), and
/// - those around the two vertices across it, denoised, each the mean of the faces that look about the way of the
///   edge's face on that side: noise does not persist that far;
/// and less if the first is no more than about half of the second, as on tightly curved parts without a crease.
/// Edges with other than two faces are no features. Replaces the selection of edges (for `features` of a pyramid) or
/// vertices.
/// @throws InputError  naming the parameter; see require_usable
/// Cost: that of the normal field, half a second for 100,000 vertices; O(n log n) for the lines.
Result feature_lines(const Layer& layer, const FeatureLineOptions& options, Session& session);

}  // namespace multires
