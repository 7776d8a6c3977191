// Solutions of symmetric positive semidefinite systems, compiled once: Eigen's decompositions take g++ some
// ten seconds in each file that uses them. For .cc files of diagnose/ only.
#pragma once

#include <Eigen/Core>

namespace hydro::maths {

// X with A X = B.
Eigen::MatrixXd SolveSymmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

// A'B, A'A: products, for the same reason.
Eigen::MatrixXd TransposeTimes(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

// A = V diag(values) V'.
struct Eigensystem {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  // V
};
Eigensystem EigensystemOf(const Eigen::MatrixXd& A);

}  // namespace hydro::maths
