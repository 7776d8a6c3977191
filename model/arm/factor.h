// M = L D L^T for a small symmetric, positive definite matrix, without allocation, and with the same bits
// however it is compiled.
#pragma once

#include <span>

namespace hydro::model {

// Factors in place, with entry (i, j) at matrix[i + j n]. Afterwards the diagonal has D^-1, and below it is L
// without its ones. Entries above the diagonal are neither read nor written. Returns false if the matrix is
// not positive definite, to rounding.
bool Factor(int n, std::span<double> matrix);

// Solves M x = b in place with the factors.
void SolveFactored(int n, std::span<const double> factors, std::span<double> x);

// The diagonal of M^-1 from the factors.
void InverseDiagonal(int n, std::span<const double> factors, std::span<double> diagonal);

}  // namespace hydro::model
