// Linear least squares with confidence intervals.
#pragma once

#include <vector>

namespace hydro::maths {

struct LinearFit {
  std::vector<double> coefficients;
  std::vector<double> covariance;  // of the coefficients, row by row
  double residual_deviation = 0;   // standard deviation of a measurement about the fit
  int degrees_of_freedom = 0;      // measurements less coefficients

  // Of the sum of weights[i] * coefficients[i]: its value, its standard error, and half the width of its 95 %
  // confidence interval after Student. The last is infinite without degrees of freedom.
  double Value(const std::vector<double>& weights) const;
  double StandardError(const std::vector<double>& weights) const;
  double HalfWidth95(const std::vector<double>& weights) const;
};

// Fits y = sum of coefficient i times regressors[i], all of y's length and of full rank, by equal weights:
// the scatter about the fit is the measure of the measurements' errors. Throws std::invalid_argument when
// there are fewer measurements than coefficients or the regressors depend on each other.
LinearFit FitLinear(const std::vector<std::vector<double>>& regressors, const std::vector<double>& y);

// The value that Student's t stays below in size with a probability of 95 %; infinity for 0 degrees.
double StudentT95(int degrees_of_freedom);

}  // namespace hydro::maths
