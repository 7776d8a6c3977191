#include "base/maths/solve.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace hydro::maths {

Eigen::MatrixXd SolveSymmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.ldlt().solve(B);
}

Eigen::MatrixXd TransposeTimes(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.transpose() * B;
}

SymmetricEigensystem SymmetricEigensystemOf(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

}  // namespace hydro::maths
