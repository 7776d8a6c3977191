// Solutions and eigenvectors of symmetric systems, compiled once: Eigen's decompositions take g++ about ten
// seconds in each file that uses them. For general matrices see base/maths/matrix_functions.h.
#pragma once

#include <Eigen/Core>

namespace hydro::maths {

// The X that solves A X = B.
Eigen::MatrixXd SolveSymmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

// The products A'B and A'A, compiled once for the same reason.
Eigen::MatrixXd TransposeTimes(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

// A = V diag(values) V' for a symmetric matrix, values in increasing order.
struct SymmetricEigensystem {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  // V
};
SymmetricEigensystem SymmetricEigensystemOf(const Eigen::MatrixXd& A);

}  // namespace hydro::maths
