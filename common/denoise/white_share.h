#pragma once

#include "denoise/along_normals.h"
#include "denoise/risk.h"

#include <functional>

/// How much of what looks like noise is white, as noise is. A rough surface, such as terrain, bark or a coarse mesh of
/// many features, has details everywhere, too, but the less the finer they are.
namespace multires {

/// The share of an energy of details that is white noise, if the rest is a rough surface, whose energy falls with the
/// frequency l (eigenvalue of the Laplacian) as l^-p. Details of order k of noise have the energies N_k = sum l^2k, and
/// those of such a surface, in these units, about (N_(k-1) / N_k)^(p/2). This falls with k, while noise is the same for
/// all.
/// @param lower, higher  energies of details of two orders, in units of those of noise
/// @param falls          N_(k-1) / N_k of the higher order by that of the lower one
/// @returns              of `lower`, in [0, 1]
double white_share(double lower, double higher, double falls);

/// What chance may add to it on a mesh of so many vertices.
double error_of_white_share(Index vertices);

/// The same of what a blend of candidates takes out, less what chance may add: of differences of order 1 and 3, in
/// units of the blend's response to the probe. Creases that the blend keeps do not count, as they do in the details of
/// the surface.
/// @param surface     gives the differences
/// @param candidates  moves and responses, see risk.h
/// @param core        #V: vertices that count
/// Cost: linear
double white_share_removed(const AlongNormals& surface, const Neighbours& near, const std::vector<Response>& candidates,
                           const Eigen::VectorXd& weights, const std::vector<std::uint8_t>& core);
/// The same of moves.
/// @param detail  the linear differences of one order of three channels, #V by 3
/// @param h       #V by 3: moves and their response to the probe; the last channel does not matter
double white_share_removed(const std::function<std::vector<double>(const std::vector<double>&)>& detail,
                           const Neighbours& near, std::vector<double> h, const std::vector<std::uint8_t>& core);

}  // namespace multires
