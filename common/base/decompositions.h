#pragma once

#include <Eigen/Geometry>

namespace multires {

// Eigen's decompositions of small matrices, compiled once: a translation unit that does it itself takes seconds more.

/// Eigenvalues, ascending, and unit eigenvectors (columns, up to sign) of a symmetric matrix.
struct PrincipalAxes {
    Eigen::Vector3d values;
    Eigen::Matrix3d vectors;
};

/// By QR iterations: eigenvectors are orthogonal to rounding. Cost: a microsecond.
PrincipalAxes principal_axes(const Eigen::Matrix3d& symmetric);

/// In closed form: several times faster, eigenvectors to about 1e-8.
PrincipalAxes principal_axes_in_closed_form(const Eigen::Matrix3d& symmetric);

/// The solution of A x = b by a pivoted LDL' decomposition; not finite where A is singular.
/// @param symmetric  A, #N by #N, positive or negative semidefinite; its lower half is read
/// @param right      b, #N
Eigen::VectorXd solve_symmetric(const Eigen::Ref<const Eigen::MatrixXd>& symmetric,
                                const Eigen::Ref<const Eigen::VectorXd>& right);

/// The turn, scaling and shift that bring points nearest to others, by least squares: Umeyama, Least-squares estimation
/// of transformation parameters between two point patterns, IEEE PAMI 13 (4), 1991.
/// @param from, to  3 by #P
Eigen::Affine3d least_squares_similarity(const Eigen::Ref<const Eigen::Matrix3Xd>& from,
                                         const Eigen::Ref<const Eigen::Matrix3Xd>& to);

}  // namespace multires
