#pragma once

#include "base/progress.h"
#include "pyramid/options.h"

namespace multires {

/// Numbers of one level. Level 0 is the input.
struct LevelInfo {
    Index vertices = 0;     ///< isolated ones not counted
    double wavelength = 0;  ///< 2 x mean edge length of the level's mesh, mesh units: the finest wave it can carry
    double rms_detail = 0;  ///< root mean square length of the details between it and the next, mesh units
};

/// The pyramid of a layer: its hierarchy, and its positions as a scheme stores them. Immutable, so that filters and
/// layers can share it.
class Pyramid {
public:
    /// @throws InputError  for features that the layer does not have
    /// @param layer_read  called when the layer is not needed any more; it may be gone from then on
    Pyramid(const Layer& layer, const PyramidOptions& options, const Progress& progress,
            const std::function<void()>& layer_read = {});

    /// Without positions: place p is vertex order[p] of the layer.
    const Hierarchy& hierarchy() const { return hierarchy_; }
    const Scheme& scheme() const { return *scheme_; }
    const Coefficients& coefficients() const { return coefficients_; }  ///< see widen()
    /// Levels 0..L: one more than there are sets of details; the last is the base.
    const std::vector<LevelInfo>& levels() const { return levels_; }
    const ContentHash& hash() const { return hash_; }    ///< content_hash() of layer and options
    const ContentHash& shape() const { return shape_; }  ///< shape_hash() of the layer
    /// Memory it holds.
    std::size_t bytes() const { return bytes_; }

    /// Largest distance between the input's vertices and what synthesis without any gain gives, mesh units.
    /// @param position  of a vertex of the layer; several are asked for at once
    double reconstruction_error(const std::function<Vec3(Index)>& position) const;

    /// Positions with the details of each level multiplied by a gain, in order of the input.
    Positions synthesise(std::vector<double> gain) const;

private:
    ContentHash hash_, shape_;
    Hierarchy hierarchy_;
    std::unique_ptr<Scheme> scheme_;
    Coefficients coefficients_;
    std::vector<LevelInfo> levels_;
    std::size_t bytes_ = 0;
};

}  // namespace multires
