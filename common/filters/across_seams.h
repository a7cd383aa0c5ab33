#pragma once

#include "filters/filter.h"
#include "mesh/seams.h"

#include <functional>
#include <memory>

/// Filters on meshes that are cut along seams (mesh/seams.h): they work on the mesh with its seams closed, so that
/// these do not open, and the result goes back to every vertex.
namespace multires {

/// A layer with its seams closed. A vertex of a closed seam is selected if all that are there are, and its attributes
/// are those of the first; a quality is the least, for it is a mask.
struct ClosedLayer {
    JoinedVertices seams;
    Layer layer;
};

/// Null if the layer has no seams.
std::shared_ptr<const ClosedLayer> close_seams(const Layer& layer);

/// The same, but for seams where the two sides differ in the values that a filter changes: what jumps there is to jump
/// there afterwards.
/// @param closed      close_seams(layer)
/// @param attributes  those the filter changes, indices into Layer::attributes
std::shared_ptr<const ClosedLayer> open_where_values_differ(const Layer& layer,
                                                            const std::shared_ptr<const ClosedLayer>& closed,
                                                            const std::vector<std::size_t>& attributes);

/// Runs a filter on the closed layer; vertices that were one get the same result. Without one it is the filter alone.
/// Of other layers, those with the very faces of the current one are closed as it is, and `source_vertex` of its levels
/// names vertices of the closed layer.
///
/// A new layer has vertices of a seam once where all attributes read are the same at them. Where they differ, there is
/// one for each value that its faces have, chosen as wedges are (WedgeCharts); all of them are at one place. If the
/// filter removes no vertex, none is joined.
/// @param closed  of the current layer, or null
Result across_seams(const Inputs& inputs, const ClosedLayer* closed, Session& session,
                    const std::function<Result(const Inputs&)>& filter);

}  // namespace multires
