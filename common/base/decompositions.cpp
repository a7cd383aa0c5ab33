#include "base/decompositions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace multires {

PrincipalAxes principal_axes(const Eigen::Matrix3d& symmetric) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(symmetric);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

PrincipalAxes principal_axes_in_closed_form(const Eigen::Matrix3d& symmetric) {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(symmetric);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd solve_symmetric(const Eigen::Ref<const Eigen::MatrixXd>& symmetric,
                                const Eigen::Ref<const Eigen::VectorXd>& right) {
    return Eigen::LDLT<Eigen::MatrixXd>(symmetric).solve(right);
}

Eigen::Affine3d least_squares_similarity(const Eigen::Ref<const Eigen::Matrix3Xd>& from,
                                         const Eigen::Ref<const Eigen::Matrix3Xd>& to) {
    return Eigen::Affine3d(Eigen::umeyama(from, to));
}

}  // namespace multires
