#include "base/maths/matrix_functions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <unsupported/Eigen/MatrixFunctions>

namespace hydro::maths {

Eigen::VectorXcd Eigenvalues(const Eigen::MatrixXd& A) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(A, /*computeEigenvectors=*/false).eigenvalues();
}

Eigensystem Eigenvectors(const Eigen::MatrixXd& A) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::MatrixXd Exponential(const Eigen::MatrixXd& A) { return A.exp(); }

Eigen::MatrixXd Inverse(const Eigen::MatrixXd& A) { return A.inverse(); }

Eigen::VectorXcd Resolvent(const Eigen::MatrixXd& A, std::complex<double> s, const Eigen::VectorXd& b) {
  Eigen::MatrixXcd resolvent = -A.cast<std::complex<double>>();
  resolvent.diagonal().array() += s;
  return resolvent.partialPivLu().solve(b.cast<std::complex<double>>());
}

Eigen::MatrixXd SolveSymmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.ldlt().solve(B);
}

Eigen::MatrixXd SolveScaled(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, double damping) {
  constexpr double kNothing = 1e-300;  // keeps the scale of an unknown without any information finite
  const Eigen::VectorXd scale = (A.diagonal().array() + kNothing).rsqrt();
  Eigen::MatrixXd scaled = scale.asDiagonal() * A * scale.asDiagonal();
  scaled.diagonal().array() += damping;
  return scale.asDiagonal() * SolveSymmetric(scaled, scale.asDiagonal() * B);
}

SymmetricEigensystem SymmetricEigensystemOf(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

}  // namespace hydro::maths
