#include "runs/step_response.h"

#include <algorithm>
#include <cmath>

namespace hydro::runs {
StepResponse MeasureStep(const std::vector<double>& times, const std::vector<double>& angles, size_t begin,
                         size_t end, double from, double to, double least_tolerance) {
  StepResponse step;
  step.time_s = times[begin];
  step.from_rad = from;
  step.to_rad = to;
  const double size = to - from;
  step.tolerance_rad = std::max(kSettlingBand * std::fabs(size), least_tolerance);
  double sum = 0;
  int count = 0;
  for (size_t i = begin; i < end; ++i) {
    const double error = angles[i] - to;
    step.overshoot_percent = std::max(step.overshoot_percent, 100 * error / size);
    if (std::fabs(error) > step.tolerance_rad) {
      step.settling_time_s.reset();
    } else if (!step.settling_time_s) {
      step.settling_time_s = times[i] - step.time_s;
    }
    if (times[end - 1] - times[i] <= kFinalTime) {
      sum += error;
      ++count;
    }
  }
  step.final_error_rad = sum / count;
  return step;
}

}  // namespace hydro::runs
