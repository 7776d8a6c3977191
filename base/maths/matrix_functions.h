// Linear algebra on matrices of any size: Eigen's decompositions, compiled once, because they cost seconds in
// each file that instantiates them.
#pragma once

#include <Eigen/Core>
#include <complex>

namespace hydro::maths {

struct Eigensystem {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;  // columns of length 1, in the order of the values
};

// The eigenvalues of a square matrix, in no particular order.
Eigen::VectorXcd Eigenvalues(const Eigen::MatrixXd& A);
Eigensystem Eigenvectors(const Eigen::MatrixXd& A);

// exp(A): the transition matrix of x' = A x over one unit of time.
Eigen::MatrixXd Exponential(const Eigen::MatrixXd& A);

Eigen::MatrixXd Inverse(const Eigen::MatrixXd& A);

// (s I - A)^-1 b: the states' response at s (or z) to an input that enters through b.
Eigen::VectorXcd Resolvent(const Eigen::MatrixXd& A, std::complex<double> s, const Eigen::VectorXd& b);

// Solutions and eigenvectors of symmetric systems, compiled once: Eigen's decompositions take g++ about ten
// seconds in each file that uses them. For general matrices see base/maths/matrix_functions.h.

// The X that solves A X = B.
Eigen::MatrixXd SolveSymmetric(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

// The same for a positive semidefinite A whose unknowns have units of their own: each is measured by the root
// of its place on the diagonal. `damping`, a part of that place, is added to it, so that an unknown that A
// does not show stays at 0.
Eigen::MatrixXd SolveScaled(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, double damping);

// A = V diag(values) V' for a symmetric matrix, values in increasing order.
struct SymmetricEigensystem {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  // V
};
SymmetricEigensystem SymmetricEigensystemOf(const Eigen::MatrixXd& A);

}  // namespace hydro::maths
