#pragma once

#include "denoise/neighbours.h"

#include <array>

namespace multires {

/// Linear smoothing of a surface along fixed normals: vertex i is at p_i + h_i n_i, and only its height h_i changes, so
/// that nothing drifts within the surface. With weights w of the entries the Laplacian along the normals is
///     (L h)_i = n_i . (sum_j w_ij (p_j + h_j n_j) - p_i - h_i n_i),
/// affine in h. Beside the heights of the surface go the responses to two samples of noise along the normals: the same
/// operator without its constant part.
class AlongNormals {
public:
    /// @param weight  #entries, rows that sum to 1; empty: equal weights
    AlongNormals(const Neighbours& near, const Positions& p, const Array<Vec3>& normal,
                 const std::vector<double>& weight);

    /// -(L h), the detail of each vertex, of all channels.
    /// @param h  #V by 3: height, noise, other noise
    std::vector<double> detail(const std::vector<double>& h) const;
    /// The same without the constant part, in all channels.
    std::vector<double> linear_detail(const std::vector<double>& h) const;

    /// `steps` pairs of one step inwards and one outwards, like Taubin's (1995) but of the same length, 0.5: long waves
    /// are kept and not amplified, 1 - k^2 / 4 for each pair where k is the frequency (eigenvalue of -L).
    /// @param h  #V by 1, 2 or 3: height, noise, other noise
    void smooth(std::vector<double>& h, int steps) const;

private:
    template <int width>
    std::array<double, width> neighbours_of(const std::vector<double>& h, Index v) const;  ///< weighted sum
    template <int width>
    void smooth_channels(std::vector<double>& h, int steps) const;
    std::vector<double> detail(const std::vector<double>& h, double constant) const;

    const Neighbours& near_;
    std::vector<double> constant_;  ///< #V: L 0
    std::vector<double> weight_;    ///< #entries: w_ij n_i . n_j
};

}  // namespace multires
