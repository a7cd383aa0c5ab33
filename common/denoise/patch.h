#pragma once

#include "mesh/mesh.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace multires {

/// A plane, or a height over one that is a polynomial of second degree.
struct Patch {
    Vec3 center, x, y, z;          ///< the axes are orthonormal
    std::array<double, 3> bend{};  ///< z = bend . (x^2, x y, y^2)

    int terms() const { return bend == std::array<double, 3>{} ? 3 : 6; }  ///< that were fitted
    double height(const Vec3& p) const;                                    ///< over the patch along z
    Vec3 gradient(const Vec3& p) const;  ///< of the height: normal of the patch, not of unit length
};

/// What is known of the errors of the places given: they were rounded, or there is Gaussian noise along the normals.
class PlaceErrors {
public:
    /// @param step  of the lattice of the coordinates
    static PlaceErrors of_rounding(double step);
    /// @param deviation  #V: where there is much less than elsewhere it is taken for somewhat more
    static PlaceErrors of_noise(std::vector<double> deviation);

    double deviation(Index v) const { return rounded() ? rounding_ : deviation_[v]; }
    double weight(Index v) const { return 1 / (deviation(v) * deviation(v)); }  ///< in least squares
    double spread() const;  ///< deviation of the square, by its mean
    /// Whether a place may be so high over a patch.
    bool allows(double height, const Vec3& gradient, Index v) const;
    double farthest(Index v) const;  ///< that noise moves a vertex
    bool rounded() const { return step_ > 0; }
    double step() const { return step_; }

private:
    double step_ = 0, rounding_ = 0;  ///< of the lattice; deviation of a uniform error
    std::vector<double> deviation_;
};

/// Terms of a polynomial in two variables.
constexpr int terms_up_to(int degree) { return (degree + 1) * (degree + 2) / 2; }

/// The polynomial over the plane of a patch that is nearest to what the places are off the patch, by least squares.
struct PatchFit {
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 15, 1> coefficient;  ///< of 1, x, y, x^2, x y, y^2, x^3, ...
    double scale = 1;                                                ///< unit of x and y
    double tilt = 0;                                                 ///< RMS of the gradient of what was fitted
    double tilt_by_noise = 0;                                        ///< the same of what is fitted to the errors
};

/// @param degree  4 at most
/// Cost: some hundred operations a vertex
PatchFit fit_over(const Patch& patch, const std::vector<Index>& vertices, const Positions& places,
                  const PlaceErrors& errors, int degree);

}  // namespace multires
