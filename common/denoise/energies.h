#pragma once

#include "denoise/along_normals.h"

namespace multires {

/// Local energies of the details of a surface and of two samples of white noise, in units of what white noise of
/// deviation 1 leaves in the same details at the same place of the same mesh. So neither the irregularity nor the
/// valences matter: white noise has the same energy everywhere and for all details.
struct Energies {
    std::vector<double> field;                 ///< of the surface, squared mesh units
    std::array<std::vector<double>, 2> noise;  ///< of the samples, about 1

    /// The energy that a share of the vertices stays below, in units of the same of the noise.
    double quantile(double share) const;
    double mean() const;
};

/// Squares, averaged over a few rings.
/// @param detail  #V by 3: of the surface, of noise, of other noise
std::vector<double> local_squares(const Neighbours& near, const std::vector<double>& detail);

/// @param energy  #V by 3: local_squares() of details
/// @param inner   vertices that count
Energies local_energies(const Neighbours& near, const std::vector<double>& energy, const std::vector<Index>& inner);

/// How much the largest details stand out of those around them: mean square by squared mean size, each detail taken in
/// units of the energy around it, by the same of noise. 1 for Gaussian noise, whatever its strength from place to
/// place, more for features, texture and impulses.
double peakedness(const std::vector<double>& detail, const std::vector<double>& energy,
                  const std::vector<Index>& inner);
/// The same over the quietest places of the surface, and of each sample of noise.
/// @param local  energies of `inner`
/// @param share  of the vertices, those with the least of them
double peakedness(const std::vector<double>& detail, const std::vector<double>& energy, const std::vector<Index>& inner,
                  const Energies& local, double share);

/// The part of the energy that does not go with the bends: `energy` = noise + share x (bends - noise), fitted to tenths
/// of the vertices by their bends, less what the noise's own fluctuations have in common.
double without_bends(const Energies& energy, const Energies& bends);

}  // namespace multires
