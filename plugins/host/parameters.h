#pragma once

#include "host/api.h"

namespace multires::host {

/// The parameters of `filter` as the host shows them, with defaults for `layer` (null: no mesh).
/// Where the defaults cannot be derived from the layer (it is bad input, say), the fixed ones are given: what is wrong
/// with the mesh is reported when the filter runs, not when its dialog opens. The default of a LayerRef is the first
/// layer of the document that is not the current one.
RichParameterList declare_parameters(const plugin::Filter& filter, const Layer* layer, const MeshDocument& document);

/// Writes what the host's list holds to the fields of the parameters. A parameter that the list lacks keeps its
/// default, as does one that the host only rounded to its own precision.
/// @return the models that the LayerRefs name, in order: LayerRef::place is the index. None is null; several may be
///         the same one.
/// @throws InputError  naming the parameter: see plugin::set; or there is no such layer
std::vector<const MeshModel*> read_parameters(const RichParameterList& list, const plugin::Parameters& parameters,
                                              const MeshDocument& document);

}  // namespace multires::host
