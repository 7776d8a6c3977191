// The response of an arm to one step of its reference: overshoot, settling time, remaining error.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace hydro::runs {

// The response to one step, until the next step or the end of the run.
struct StepResponse {
  double time_s = 0;
  double from_rad = 0;  // reference before and after
  double to_rad = 0;
  double overshoot_percent = 0;  // of the step; 0 when the arm never went beyond the reference
  double tolerance_rad = 0;      // kSettlingBand of the step, or the least tolerance where that is more
  std::optional<double> settling_time_s;  // until the error stays within the tolerance; none: it never does
  double final_error_rad = 0;             // arm minus reference, the mean over the last kFinalTime
};

// The share of the step within which a response counts as settled.
inline constexpr double kSettlingBand = 0.02;

// The time at the end, in s, over which errors are averaged.
inline constexpr double kFinalTime = 0.1;

// Measures the samples [begin, end) of `times` (s, increasing) and `angles` (rad). The first of them lies at
// the step from `from` to `to`.
StepResponse MeasureStep(const std::vector<double>& times, const std::vector<double>& angles, size_t begin,
                         size_t end, double from, double to, double least_tolerance = 0);

}  // namespace hydro::runs
