#pragma once

#include "pyramid/pyramid.h"

namespace multires {

/// What band limits are given in.
enum class Unit {
    wavelength,          ///< mesh units, as in the table of levels: 2 x mean edge length of a level
    wavelength_percent,  ///< of the diagonal of the bounding box: 1 = 1 %
    level,               ///< 0 = finest; 2.5 = halfway (in the logarithm) between levels 2 and 3
    vertices,            ///< number of vertices of a level (Guskov et al. 1999: "1000 < n < 7000")
};

/// A range of scales. `finest` < `coarsest` in every unit but vertices, where more vertices are finer.
struct Band {
    Unit unit = Unit::wavelength;
    double finest = 0;
    double coarsest = 0;
    /// Width of each edge in octaves of wavelength, >= 0: over it the gain goes from 1 to that of the band.
    double softness = 0;
};

/// @throws InputError if the limits are not finite, out of range or out of order, naming them
void check(const Band& band, double box_diagonal);

/// Mesh units of a limit in levels or numbers of vertices.
double wavelength_of(const Pyramid& pyramid, Unit unit, double limit);

/// Share of each level's details that lies in the band, in [0, 1].
///
/// Level k holds the waves between its own wavelength and that of level k+1; a level that the edge of the band cuts
/// belongs to it in part, so that results change steadily with the limits.
/// @throws InputError if the limits are not finite, out of range or out of order
std::vector<double> band_share(const Pyramid& pyramid, const Band& band, double box_diagonal);
/// The same of levels that no pyramid of collapses has.
std::vector<double> band_share(const std::vector<LevelInfo>& levels, const Band& band, double box_diagonal);

/// Gains for synthesis: 1 outside the band, `gain` inside, between them at its edges.
std::vector<double> band_gains(const Pyramid& pyramid, const Band& band, double box_diagonal, double gain);

/// A band that does something useful on the layer: waves of about 2 to 8 times the finest the mesh can carry.
Band default_band(const Layer& layer, Unit unit);

/// A cutoff that does: about 4 times the finest wave.
double default_cutoff(const Layer& layer, Unit unit);

/// Length of 100 %: the diagonal of the box around all vertices.
double box_diagonal(const Layer& layer);

}  // namespace multires
