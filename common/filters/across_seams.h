#pragma once

#include "filters/filter.h"

#include <functional>

namespace multires {

/// The layer with its seams closed; empty if it has none.
std::optional<Layer> closed_layer(const Layer& layer);

/// Runs a filter that changes vertices on the layer with its seams closed (mesh/seams.h), so that they do not open; all
/// that were one get the same result. On a layer without seams it is the filter alone. A vertex of a closed seam is
/// selected if all that are there are, and its attributes are those of the first; a mask in the quality is the least.
/// @param filter  gives a result without a new layer
Result across_seams(const Layer& layer, Session& session, const std::function<Result(const Layer&)>& filter);

}  // namespace multires
