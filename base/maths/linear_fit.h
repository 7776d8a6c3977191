// Linear least squares with confidence intervals.
#pragma once

#include <vector>

namespace hydro::maths {

struct LinearFit {
  std::vector<double> coefficients;
  std::vector<double> covariance;  // covariance of the coefficients, row by row
  double residual_deviation = 0;   // standard deviation of the measurements about the fit
  int degrees_of_freedom = 0;      // number of measurements minus number of coefficients

  // For the sum of weights[i] * coefficients[i]: its value, its standard error, and half the width of its 95
  // % confidence interval (Student), which is infinite with no degrees of freedom.
  double Value(const std::vector<double>& weights) const;
  double StandardError(const std::vector<double>& weights) const;
  double HalfWidth95(const std::vector<double>& weights) const;
};

// Fits y = sum of coefficient i times regressors[i] with equal weights. The regressors have y's length and
// full rank. The scatter about the fit measures the measurements' errors. Throws std::invalid_argument when
// there are fewer measurements than coefficients or the regressors depend on each other.
LinearFit FitLinear(const std::vector<std::vector<double>>& regressors, const std::vector<double>& y);

// The magnitude below which Student's t stays with a probability of 95 %; infinity for 0 degrees of freedom.
double StudentT95(int degrees_of_freedom);

}  // namespace hydro::maths
