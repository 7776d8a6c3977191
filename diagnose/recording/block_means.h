// Measured signals against each other, without any model of the oil: means over consecutive stretches of runs
// in the place of derivatives of noisy signals, and straight lines through them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

// Consecutive samples of a run.
struct RunBlock {
  const runs::MeasuredRun* run;
  size_t first, last;  // both included

  double seconds() const { return run->time[last] - run->time[first]; }
  // Over time. NaN where the signal was not measured, or a sample is missing.
  double Mean(const runs::MeasuredSignal& signal) const;
  double Rate(const runs::MeasuredSignal& signal) const;
};

// Blocks of 0.1 s, or of four samples of slower recorders; none where rows are missing.
std::vector<RunBlock> RunBlocksOf(const runs::MeasuredRun& run);

// Coefficients of a fit, and half of their 95 % intervals.
struct FittedBlocks {
  std::vector<double> value, half;
};
// Least squares of y on some columns. Empty where there are fewer than 20 values, where the fit leaves so
// much that the two have nothing to do with each other, and where the columns depend on each other. A column
// that is 0 throughout has the coefficient 0.
std::optional<FittedBlocks> FitBlocks(std::vector<std::vector<double>> columns, const std::vector<double>& y);

// The correlation of x and y, -1 to 1, and 0 where y never changes. Empty where there are fewer than 6
// values, and where the standard deviation of x is not above `least`.
std::optional<double> CorrelationOfBlocks(const std::vector<double>& x, const std::vector<double>& y,
                                          double least);

// "1.14 +/- 0.0012": no ratio is known to more than three digits, however small the scatter is.
std::string WithHalfWidth(double value, double half);

}  // namespace hydro::diagnose
