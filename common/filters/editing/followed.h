#pragma once

#include "editing/multiband.h"
#include "filters/editing/proxies.h"
#include "filters/editing/transfer_edit.h"
#include "filters/intermediate.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace multires {

/// All of Follow Edited Layer that depends neither on the gain nor on what becomes of details: kept with the layer, so
/// that previews of these do not wait for it.
class FollowedEdit final : public Intermediate {
public:
    using Intermediate::Intermediate;
    std::size_t bytes() const override;

    FoundProxy::Way way = FoundProxy::Way::pair;
    std::string text;  ///< how the proxy was found
    bool unchanged = false;
    std::size_t proxy_vertices = 0;
    double distance = 0;   ///< RMS of the layer to the proxy, mesh units
    Array<Mat3> gradient;  ///< #V, of the displacement
    /// The layer after the edit (gradient), the shape of a level after it (frames), the base points of the vertices on
    /// the edited proxy (phong over it), or the coarsest base after the edit (phong over bases). #V by 3; frames: in
    /// places of the pyramid.
    Positions shape;
    Positions detail, turned;        ///< phong over the proxy: from the base points, before and after
    Index border = 0, nearest = 0;   ///< base points of these kinds
    std::optional<Multiband> bands;  ///< phong over bases
    std::vector<Index> kept;         ///< vertices that these keep
};

/// Hash of all that a FollowedEdit is made of.
ContentHash followed_hash(const Inputs& inputs, const TransferEditOptions& options);

/// @param hash  followed_hash()
std::shared_ptr<const FollowedEdit> solve_edit(const Layer& layer, const TransferEditOptions& options,
                                               const FoundProxy& found, const ContentHash& hash, Session& session,
                                               Report& report);

}  // namespace multires
