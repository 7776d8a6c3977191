// Solutions and eigenvectors of symmetric systems, compiled once: Eigen's decompositions take g++ some ten
// seconds in each file that uses them. General matrices: maths/matrix_functions.h.
#pragma once

#include <Eigen/Core>

namespace hydro::maths {

// X with A X = B.
Eigen::MatrixXd SolveSymmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

// A'B, A'A: products, for the same reason.
Eigen::MatrixXd TransposeTimes(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

// A = V diag(values) V', of a symmetric matrix; values in increasing order.
struct SymmetricEigensystem {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  // V
};
SymmetricEigensystem SymmetricEigensystemOf(const Eigen::MatrixXd& A);

}  // namespace hydro::maths
