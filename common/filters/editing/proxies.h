#pragma once

#include "editing/proxy.h"
#include "filters/filter.h"
#include "hierarchy/hierarchy.h"

#include <string>

namespace multires {

struct TransferEditOptions;

/// A proxy in the coordinates of the current layer, and how it was found.
struct FoundProxy {
    enum class Way { level = 1, pair = 2, wrapped = 3 };

    Faces faces;
    Positions before, after;
    Way way = Way::pair;
    std::string text;        ///< how it was found, for people
    bool unchanged = false;  ///< before and after are the same

    Proxy proxy() const { return {faces, before, after}; }
};

/// require_usable() for another layer.
/// @throws InputError  beginning with the parameter that names it
void require_layer(const Layer& layer, const char* which);

/// As many vertices and the same faces, in any order and from any corner on: editors turn them.
bool same_connectivity(const Mesh& a, const Mesh& b);

/// The level with the number of vertices nearest to a number, in the logarithm.
std::size_t nearest_level(const Hierarchy& h, std::size_t vertices);

/// See transfer_edit().
FoundProxy find_proxy(const Inputs& inputs, const TransferEditOptions& options, Session& session, Report& report);

/// Refuses feet on a proxy that lies elsewhere than the layer, and says how.
/// @param distance_of_nearest  distance to the proxy that a tenth of the vertices keep within
void require_near(const Layer& layer, const FoundProxy& found, double distance_of_nearest);

}  // namespace multires
