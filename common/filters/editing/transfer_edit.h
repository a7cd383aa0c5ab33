#pragma once

#include "filters/filter.h"
#include "filters/region.h"

namespace multires {

/// How the surface between the vertices of the proxy follows it.
enum class Encoding {
    gradient,  ///< one Poisson solve for gradients turned and stretched by the proxy's motion
               ///< (editing/gradient_domain.h)
    frames,    ///< a level of the pyramid moves; details in frames of coarser levels follow (Guskov et al. 1999, 4.4)
    phong,     ///< a smooth base moves; details along Phong fields of normals follow (Vorsatz and Kobbelt 1999)
};

/// What happens to the detail that is finer than the proxy.
enum class DetailsFollow {
    multiresolution,  ///< turns and stretches with the surface
    single,           ///< keeps its direction in space
    none,             ///< is left out: the coarse shape alone
};

/// Lets a layer follow the edit of a coarse mesh near it.
struct TransferEditOptions {
    LayerRef edited;  ///< the proxy as it is now
    /// The proxy as it was before, with the same vertices and faces. The same layer as `edited`, or the current one:
    /// there is none.
    LayerRef before;
    DetailsFollow details = DetailsFollow::multiresolution;
    double gain = 1;  ///< finite: factor of the detail finer than the proxy
    Encoding encoding = Encoding::gradient;
    /// Phong: 1: heights over the proxy itself; 2 to 8: a base that keeps as many vertices as the proxy has and
    /// bands - 1 bands of detail over it (filters/editing/bands.h). A proxy with the faces of the layer itself, as
    /// Smooth Base as Layer makes it, is that base.
    int bands = 5;
    Region region;
    double soft_border = 0;  ///< mesh units, >= 0: inside the selection, how far from its border it takes full effect
    PyramidOptions pyramid;  ///< for a gain other than 1, details that do not turn, frames and bases
};

/// Finds what `edited` was before, in this order, and says so in the report as `way`:
///
/// 2. `before`, if given; it must have the same number of vertices, and the same faces.
/// 1. The level of this layer that it is: by the attribute of source vertices that Level as New Layer writes, by equal
///    faces (a copy of the whole layer), or by the level of the pyramid with these options that has the same faces.
/// 3. Otherwise the nearest level of the pyramid, wrapped onto `edited` (editing/wrap.h).
///
/// Layers are compared where the document shows them; a layer that was moved as a whole was edited. An edit that
/// changes nothing leaves the layer as it is, bit for bit. So does any edit with all vertices out of its reach.
/// Vertices without faces follow as well.
///
/// Reports the way, how far the layer is from the proxy, faces that are folded against their neighbourhood's motion,
/// and the change.
/// @throws InputError  naming the layer, for layers that are not usable, do not fit together or lie elsewhere; for
///                     options out of range
/// Cost: linear, O(log #F) of the proxy a vertex.
Result transfer_edit(const Inputs& inputs, const TransferEditOptions& options, Session& session);

}  // namespace multires
