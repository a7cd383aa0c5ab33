#pragma once

#include "base/progress.h"
#include "editing/phong.h"

#include <vector>

namespace multires {

/// A surface as its smoothest base and details over ever finer ones (Vorsatz and Kobbelt, section 3): each shape is
/// stored by base points and heights over the next coarser one.
class Multiband {
public:
    /// @param mesh   usable: the finest shape
    /// @param bases  at least one, finest first: #V by 3 each, shapes of the same connectivity
    /// Cost: base points of all vertices, once for each base.
    Multiband(const Mesh& mesh, std::vector<Positions> bases, const Progress& progress);

    const Positions& coarsest() const { return coarsest_; }
    std::size_t bands() const { return details_.size(); }  ///< of detail

    /// The surface over another coarsest base, with the details of each band multiplied by a gain. The coarsest as it
    /// is and gains of 1 give the mesh back to rounding.
    /// @param faces  of the mesh
    /// @param gain   #bands, finest first
    Positions reconstruct(const Faces& faces, Positions coarsest, const std::vector<double>& gain) const;

    /// Root mean square length of the details of a band, mesh units.
    double rms_detail(std::size_t band) const;
    Index border() const { return border_; }    ///< base points of BaseKind::border, of all bands
    Index nearest() const { return nearest_; }  ///< and of BaseKind::nearest
    std::size_t bytes() const;                  ///< memory it holds

private:
    Positions coarsest_;
    std::vector<Array<BasePoint>> details_;
    Index border_ = 0, nearest_ = 0;
};

}  // namespace multires
