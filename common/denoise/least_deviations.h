#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace multires {

/// One round of iteratively reweighted least squares towards the least sum of absolute deviations (Schlossmacher 1973):
/// each value has a weight of one over its deviation so far. Six rounds are enough to leave single values aside.
/// @param terms              #values: what the function is a sum of, the first of them 1, all of about unit size
/// @param[in,out] deviation  #values: from the function so far, and from the one returned
/// @param least              deviation that counts, above 0: smaller ones have no more weight
/// @returns                  factors of the terms
template <int count>
Eigen::Matrix<double, count, 1> towards_least_deviations(const std::vector<Eigen::Matrix<double, count, 1>>& terms,
                                                         const std::vector<double>& values,
                                                         std::vector<double>& deviation, double least) {
    Eigen::Matrix<double, count, count> a = Eigen::Matrix<double, count, count>::Zero();
    Eigen::Matrix<double, count, 1> b = Eigen::Matrix<double, count, 1>::Zero();
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Eigen::Matrix<double, count, 1> weighted = terms[i] / std::max(std::abs(deviation[i]), least);
        for (int c = 0; c < count; ++c)  // the half that llt() reads
            for (int r = c; r < count; ++r) a(r, c) += weighted[r] * terms[i][c];
        b += values[i] * weighted;
    }
    a.diagonal().array() += 1e-6 * a.trace();  // all on a line, or on a conic
    Eigen::Matrix<double, count, 1> fit = a.llt().solve(b);
    for (std::size_t i = 0; i < values.size(); ++i) deviation[i] = values[i] - fit.dot(terms[i]);
    return fit;
}

}  // namespace multires
