#pragma once

#include "filters/filter.h"
#include "filters/region.h"

#include <string>

namespace multires {

/// Where the detail comes from, and where it goes.
enum class DetailUse {
    apply,   ///< from the layer to the current one, which moves
    store,   ///< from the layer to an attribute of the current one, which stays as it is
    stored,  ///< from that attribute to the current layer
};

/// Brings the detail of another layer, a scan say, onto the current one: its remesh, a smooth or another shape nearby.
struct TransferDetailOptions {
    DetailUse use = DetailUse::apply;
    LayerRef layer;                    ///< where the detail comes from
    std::string attribute = "detail";  ///< letters, digits and _: the attribute
    double gain = 1;                   ///< finite
    double largest_distance = 1;       ///< >= 0, mesh units: how far along its normal a vertex looks for the layer
    double finest = 0,
           coarsest = 0;  ///< >= 0, mesh units: detail of shorter and of longer waves is left out; 0: nothing
    Region region;
    PyramidOptions pyramid;  ///< for the two limits
};

/// The detail of a vertex is a vector in its frame: its normal, which is the Phong field's there (editing/phong.h), the
/// first side of its first face, and the one across both. So it turns with the surface.
///
/// From a layer with the same vertices and faces (a sculpted copy) it leads to the vertex of the same number. From any
/// other it is the height along the normal at which the layer is met, on a face that looks to the same side; vertices
/// that meet none within the largest distance take a height from around them that falls to 0 over that distance, and
/// are counted as vertices_without. Then limits and gain apply. Layers are compared where the document shows them.
///
/// With a gain of 1 and no limits the vertices that meet the layer come to lie on it. Stored detail can be applied to
/// the same faces in another shape: sculpt layers. What was stored and is applied at once gives the same as `apply`.
/// @throws InputError  naming the parameter: no such layer or attribute, no vertex that meets the layer
/// Cost: O(log #F') a vertex, one solve if some meet nothing, a pyramid for limits.
Result transfer_detail(const Inputs& inputs, const TransferDetailOptions& options, Session& session);

}  // namespace multires
