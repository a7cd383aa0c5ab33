#pragma once

#include "denoise/neighbours.h"

#include <Eigen/Core>

/// Stein's unbiased risk estimate of a blend of denoised candidates (Stein 1981; by a random probe: Ramani, Blu, Unser
/// 2008; linear in the candidates: Blu, Luisier 2007).
///
/// Heights y = x + noise with deviations s, candidates y + u_k(y), blended as y + sum_k t_k u_k. With a probe b of the
/// noise's own law and the responses v_k = du_k/dy b,
///     E |A (y + sum t_k u_k - x)|^2 = E |A noise|^2 + 2 sum t_k E<A b, A v_k> + |A sum t_k u_k|^2
/// for any linear A. Here A takes differences along edges, which suits what is seen of a surface: its normals. The
/// error of heights (A = 1) comes with it.
namespace multires {

/// Quadratic in the weights t: constant + 2 linear . t + t . quadratic t.
struct Risk {
    double constant = 0;
    Eigen::VectorXd linear;
    Eigen::MatrixXd quadratic;

    double at(const Eigen::VectorXd& t) const { return constant + 2 * linear.dot(t) + t.dot(quadratic * t); }
};

struct Risks {
    Risk edges;    ///< mean square error of the differences along edges
    Risk heights;  ///< of the heights
};

/// A candidate: #V by 2, the move u of each vertex along its normal and the response v to the probe.
using Response = std::vector<double>;

/// @param deviation  #V: of the noise
/// @param probe      #V: a sample of it
/// @param core       #V: vertices that count
/// Cost: O(entries K^2)
Risks risks(const Neighbours& near, const std::vector<Response>& candidates, const std::vector<double>& deviation,
            const std::vector<double>& probe, const std::vector<std::uint8_t>& core);

/// The weights t >= 0 with sum t <= 1 of least risk; what is left to 1 is the weight of the input itself.
Eigen::VectorXd least_risk(const Risk& risk);

}  // namespace multires
