#include "model/arm/factor.h"

#include <algorithm>

#include "model/arm/arm_description.h"

namespace hydro::model {

bool Factor(int n, std::span<double> matrix) {
  double* m = matrix.data();
  for (int j = 0; j < n; ++j) {
    double* column = m + static_cast<long>(j) * n;
    if (!(column[j] > 0)) return false;
    const double inverse = 1 / column[j];
    for (int k = j + 1; k < n; ++k) {
      const double factor = column[k] * inverse;
      double* other = m + static_cast<long>(k) * n;
      for (int i = k; i < n; ++i) other[i] -= factor * column[i];
    }
    for (int i = j + 1; i < n; ++i) column[i] *= inverse;
    column[j] = inverse;
  }
  return true;
}

void SolveFactored(int n, std::span<const double> factors, std::span<double> x) {
  const double* m = factors.data();
  for (int j = 0; j < n; ++j) {
    for (int i = j + 1; i < n; ++i) x[i] -= m[i + static_cast<long>(j) * n] * x[j];
  }
  for (int j = n - 1; j >= 0; --j) {
    x[j] *= m[j + static_cast<long>(j) * n];
    for (int i = j + 1; i < n; ++i) x[j] -= m[i + static_cast<long>(j) * n] * x[i];
  }
}

void InverseDiagonal(int n, std::span<const double> factors, std::span<double> diagonal) {
  const double* m = factors.data();
  double column[kMostLinks];  // of L^-1; M^-1 = L^-T D^-1 L^-1
  for (int j = 0; j < n; ++j) {
    std::fill(column + j, column + n, 0.0);
    column[j] = 1;
    double sum = 0;
    for (int k = j; k < n; ++k) {
      sum += column[k] * column[k] * m[k + static_cast<long>(k) * n];
      for (int i = k + 1; i < n; ++i) column[i] -= m[i + static_cast<long>(k) * n] * column[k];
    }
    diagonal[j] = sum;
  }
}

}  // namespace hydro::model
