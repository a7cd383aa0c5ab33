#pragma once

#include "pyramid/band.h"

namespace multires {

/// Factors of the details of each level, finest first, for each group of bodies.
using Gains = std::vector<std::vector<double>>;

/// True if nothing is to be changed.
bool all_one(const Gains& gains);

/// Bodies of a layer that share no edge, in groups of about the same density (half an octave of mean edge length).
///
/// Levels count vertices: each leaves about the same share of every body's, and so longer waves of a coarse body than
/// of a fine one beside it. What a wavelength is in levels can only be told body by body. Specks (mesh/specks.h) go
/// with the largest body.
class Bodies {
public:
    /// Cost: that of the base's rings if the layer is one body; otherwise linear.
    /// @param layer  that of the pyramid
    Bodies(const Pyramid& pyramid, const Layer& layer);

    /// 1 if all are of about the same density. Group 0 is that of the largest body.
    std::size_t groups() const { return own_.empty() ? 1 : own_.size(); }
    /// Pyramid::levels() with the wavelengths of one group: twice the mean length of the edges at the vertices that a
    /// level takes away.
    const std::vector<LevelInfo>& levels(std::size_t group) const { return own_.empty() ? all_.levels() : own_[group]; }

    /// What `of` gives for the levels of each group.
    template <class Of>
    Gains gains(const Of& of) const {
        Gains all;
        for (std::size_t g = 0; g < groups(); ++g) all.push_back(of(levels(g)));
        return all;
    }

    /// @param coefficients  of the pyramid's scheme
    /// @returns  in order of places. Cost: one synthesis for each group, unless its gains are those of the first
    Field synthesise(const Coefficients& coefficients, const Gains& gains) const;
    /// The positions, in order of the input.
    Positions synthesise(const Gains& gains) const;
    /// Any field on the layer with these gains, in order of the input.
    Field filter(const Field& field, const Gains& gains) const;

private:
    const Pyramid& all_;
    Array<std::uint8_t> group_;                ///< #V by place; empty if there is one group
    std::vector<std::vector<LevelInfo>> own_;  ///< of each group; empty if there is one
};

/// As band_gains() of pyramid/band.h.
std::vector<double> band_gains(const std::vector<LevelInfo>& levels, const Band& band, double box_diagonal,
                               double gain);
Gains band_gains(const Bodies& bodies, const Band& band, double box_diagonal, double gain);

}  // namespace multires
