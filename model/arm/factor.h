// M = L D L^T of a small symmetric, positive definite matrix: no allocation, and the same bits wherever it is
// compiled.
#pragma once

#include <span>

namespace hydro::model {

// In place, entry (i, j) at matrix[i + j n]: afterwards D^-1 on the diagonal and L (without its ones) below
// it; what lies above is neither read nor written. False: not positive definite, to rounding.
bool Factor(int n, std::span<double> matrix);

// Solves M x = b in place with the factors.
void SolveFactored(int n, std::span<const double> factors, std::span<double> x);

// The diagonal of M^-1 from the factors.
void InverseDiagonal(int n, std::span<const double> factors, std::span<double> diagonal);

}  // namespace hydro::model
