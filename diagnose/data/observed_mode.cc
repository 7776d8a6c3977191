#include "diagnose/data/observed_mode.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/data/sample_interval.h"

namespace hydro::diagnose {

namespace {

constexpr double kHalfWindow = 2.5e-3;  // s: short against the shortest rest that matters
constexpr double kMargin = 3.5;         // standard deviations
constexpr double kShortestRest = 0.01;  // s

// Centred averages of the values present; NaN where there are none.
std::vector<double> Average(const std::vector<double>& values, size_t half) {
  const size_t n = values.size();
  std::vector<double> sum(n + 1, 0.0), count(n + 1, 0.0);
  for (size_t i = 0; i < n; ++i) {
    const bool there = !std::isnan(values[i]);
    sum[i + 1] = sum[i] + (there ? values[i] : 0);
    count[i + 1] = count[i] + (there ? 1 : 0);
  }
  std::vector<double> average(n, std::numeric_limits<double>::quiet_NaN());
  for (size_t i = 0; i < n; ++i) {
    const size_t first = i < half ? 0 : i - half;
    const size_t last = std::min(n, i + half + 1);
    const double there = count[last] - count[first];
    if (there > 0) average[i] = (sum[last] - sum[first]) / there;
  }
  return average;
}

// Fills each gap with the value before it, and a gap at the start with the first value.
void FillGaps(std::vector<double>* values) {
  double last = 0;
  for (const double value : *values) {
    if (!std::isnan(value)) {
      last = value;
      break;
    }
  }
  for (double& value : *values) {
    if (std::isnan(value)) value = last;
    last = value;
  }
}

std::vector<double> SpeedFromAngle(const std::vector<double>& angle, const std::vector<double>& time,
                                   size_t half) {
  const size_t n = angle.size();
  std::vector<double> speed(n, std::numeric_limits<double>::quiet_NaN());
  for (size_t i = 0; i < n; ++i) {
    const size_t first = i < half ? 0 : i - half;
    const size_t last = std::min(n - 1, i + half);
    if (last > first) speed[i] = (angle[last] - angle[first]) / (time[last] - time[first]);
  }
  return speed;
}

void AverageSpeed(const RunData& run, double step, size_t half, double averaging, ObservedMode* mode) {
  const SignalData* const speed = run.Find(model::Channel::kMotorSpeed);
  const SignalData* const angle = run.Find(model::Channel::kMotorAngle);
  if (speed == nullptr && angle == nullptr) return;
  const size_t reach = std::max<size_t>(1, half);
  const double angle_margin =
      angle == nullptr ? std::numeric_limits<double>::infinity()
                       : kMargin * angle->noise * std::sqrt(0.5) / (static_cast<double>(reach) * step);
  const double speed_margin =
      speed == nullptr ? std::numeric_limits<double>::infinity() : averaging * speed->noise;
  // A difference between samples that are far apart would smear a reversal.
  const bool from_speed = speed != nullptr && (speed_margin <= angle_margin || step > kHalfWindow);
  mode->motor_speed =
      from_speed ? Average(speed->values, half) : SpeedFromAngle(angle->values, run.stimulus.time, reach);
  mode->speed_margin = from_speed ? speed_margin : angle_margin;
  FillGaps(&mode->motor_speed);
}

// Which way the pump turns from each sample to the next, as far as the averaged speed shows.
void FindTurns(ObservedMode* mode) {
  const size_t n = mode->motor_speed.size();
  mode->turns.assign(n, 0);
  mode->passes.assign(n, 0);
  const auto side = [&](size_t i) {
    const double value = mode->motor_speed[i];
    return value > mode->speed_margin ? 1 : value < -mode->speed_margin ? -1 : 0;
  };
  for (size_t i = 0; i < n; ++i) {
    const int now = side(i);
    const int next = side(std::min(n - 1, i + 1));
    if (now == next) {
      mode->turns[i] = static_cast<int8_t>(now);
    } else {
      mode->turns[i] = static_cast<int8_t>(now != 0 && next != 0 ? now : 0);
      if (now != 0 && next != 0) mode->passes[i] = 1;
    }
  }
}

// Turns a rest that is too short to be one into a passage through 0.
void DropShortRests(const std::vector<double>& time, ObservedMode* mode) {
  const size_t n = time.size();
  for (size_t i = 0; i < n;) {
    size_t end = i;
    while (end < n && mode->turns[end] == 0) ++end;
    if (end == i) {
      ++i;
      continue;
    }
    const double duration = time[std::min(n - 1, end)] - time[i];
    if (end - i < 3 || duration < kShortestRest) {
      for (size_t k = i; k < end; ++k) {
        mode->passes[k] = 1;
        mode->turns[k] = static_cast<int8_t>(mode->motor_speed[k] >= 0 ? 1 : -1);
      }
    }
    i = end;
  }
}

}  // namespace

ObservedMode ObserveMode(const RunData& run) {
  ObservedMode mode;
  const double step = MedianInterval(run.stimulus.time);
  const size_t half = static_cast<size_t>(std::min(50.0, std::floor(kHalfWindow / step)));
  mode.half_window = half;
  const double averaging = kMargin / std::sqrt(2.0 * static_cast<double>(half) + 1);
  if (const SignalData* p1 = run.Find(model::Channel::kP1)) {
    mode.p1 = Average(p1->values, half);
    mode.p1_margin = averaging * p1->noise;
  }
  if (const SignalData* p2 = run.Find(model::Channel::kP2)) {
    mode.p2 = Average(p2->values, half);
    mode.p2_margin = averaging * p2->noise;
  }
  AverageSpeed(run, step, half, averaging, &mode);
  if (mode.motor_speed.empty()) return mode;
  FindTurns(&mode);
  DropShortRests(run.stimulus.time, &mode);
  return mode;
}

}  // namespace hydro::diagnose
