#include "experiments/studies/steady_speed.h"

#include <algorithm>
#include <cmath>

#include "base/maths/linear_fit.h"
#include "base/maths/spread.h"

namespace hydro::experiments {
namespace {

constexpr int kBlocks = 10;
constexpr int kLeastSamples = 3;           // per block
constexpr int kStarts = 20;                // stretches tried per hold
constexpr double kNegligibleDrift = 1e-5;  // of the speed, over a stretch: a trend, but negligible
constexpr double kLargestShare = 5e-3;     // of the torque, for acceleration
constexpr double kSlowest = 0.01;          // of the fastest speed or largest voltage: less counts as zero

// Speed over the samples from first up to end; NaN when too few of them have a value.
double BlockSpeed(const runs::MeasuredRun& run, SpeedSource source, size_t first, size_t end) {
  const auto& values = (source == SpeedSource::kSpeed ? run.motor_speed : run.motor_angle).values;
  double sum = 0;
  int count = 0;
  size_t first_valid = end, last_valid = end;
  for (size_t i = first; i < end; ++i) {
    if (std::isnan(values[i])) continue;
    if (count++ == 0) first_valid = i;
    last_valid = i;
    sum += values[i];
  }
  if (count < kLeastSamples) return std::nan("");
  if (source == SpeedSource::kSpeed) return sum / count;
  return (values[last_valid] - values[first_valid]) / (run.time[last_valid] - run.time[first_valid]);
}

std::optional<SpeedWindow> LookAt(const runs::MeasuredRun& run, SpeedSource source, const Hold& hold,
                                  double from) {
  SpeedWindow window;
  window.from = from;
  window.to = run.time[hold.last];
  window.voltage = hold.voltage;
  const auto index = [&](double time) {
    return static_cast<size_t>(std::lower_bound(run.time.begin(), run.time.end(), time) - run.time.begin());
  };
  std::vector<double> speeds, times;
  const double width = window.duration() / kBlocks;
  for (int k = 0; k < kBlocks; ++k) {
    const size_t first = index(from + k * width);
    // A block of angles ends where the next begins, so that nothing between them is lost.
    const size_t end = k + 1 == kBlocks ? hold.last + 1 : index(from + (k + 1) * width);
    const size_t shared = source == SpeedSource::kAngle && k + 1 < kBlocks ? 1 : 0;
    const double speed = BlockSpeed(run, source, first, std::min(end + shared, hold.last + 1));
    if (std::isnan(speed)) return std::nullopt;
    speeds.push_back(speed);
    times.push_back((k + 0.5 - 0.5 * kBlocks) * width);
  }
  const maths::LinearFit line = maths::FitLinear({std::vector<double>(kBlocks, 1.0), times}, speeds);
  window.speed = line.coefficients[0];
  window.speed_error = line.StandardError({1, 0});
  window.acceleration = line.coefficients[1];
  window.acceleration_95 = line.HalfWidth95({0, 1});
  return window;
}

// The typical size of the voltage's noise, from differences of neighbours: half of them are below it.
double VoltageNoise(const runs::MeasuredRun& run) {
  if (run.voltage.noise.has_value()) return *run.voltage.noise;
  std::vector<double> differences;
  const std::vector<double>& voltage = run.voltage.values;
  for (size_t i = 1; i < voltage.size(); ++i) differences.push_back(std::abs(voltage[i] - voltage[i - 1]));
  return maths::Median(std::move(differences)) /
         (0.6745 * std::sqrt(2.0));  // a normal variable's median magnitude is 0.6745 deviations
}

}  // namespace

double SpeedWindow::LargestAcceleration() const { return std::abs(acceleration) + acceleration_95; }

std::vector<Hold> ConstantVoltage(const runs::MeasuredRun& run) {
  const std::vector<double>& voltage = run.voltage.values;
  double largest = 0;
  for (const double v : voltage) largest = std::max(largest, std::abs(v));
  const double tolerance = std::max(6 * VoltageNoise(run), 1e-9 * largest);
  std::vector<Hold> holds;
  for (size_t first = 0; first < voltage.size();) {
    double sum = voltage[first];
    size_t end = first + 1;
    while (end < voltage.size()) {
      if (std::abs(voltage[end] - sum / static_cast<double>(end - first)) > tolerance) break;
      sum += voltage[end++];
    }
    holds.push_back({first, end - 1, sum / static_cast<double>(end - first)});
    first = end;
  }
  return holds;
}

SteadySpeeds FindSteadySpeeds(const runs::MeasuredRun& run, SpeedSource source, double torque_per_volt,
                              double inertia) {
  SteadySpeeds result;
  double largest = 0;
  for (const double v : run.voltage.values) largest = std::max(largest, std::abs(v));
  for (const Hold& hold : ConstantVoltage(run)) {
    if (std::abs(hold.voltage) < kSlowest * largest) continue;  // switched off
    const double begin = run.time[hold.first];
    const double length = run.time[hold.last] - begin;
    const double torque = std::abs(torque_per_volt * hold.voltage);
    std::optional<SpeedWindow> without_trend, slow;
    for (int k = 0; k < kStarts && !without_trend.has_value(); ++k) {
      const std::optional<SpeedWindow> window = LookAt(run, source, hold, begin + k * length / kStarts);
      if (!window.has_value()) break;
      if (inertia * window->LargestAcceleration() > kLargestShare * torque) continue;
      if (!slow.has_value()) slow = window;
      const double drift = std::abs(window->acceleration) * window->duration();
      const double hidden = window->acceleration_95 * window->duration();
      if (drift <= std::max(hidden, kNegligibleDrift * std::abs(window->speed))) without_trend = window;
    }
    const std::optional<SpeedWindow> stretch = without_trend.has_value() ? without_trend : slow;
    const double from = stretch.has_value() ? stretch->from + stretch->duration() / 2 : begin + length / 2;
    std::optional<SpeedWindow> window = LookAt(run, source, hold, from);
    if (!window.has_value()) continue;
    window->hold_from = begin;
    window->first_duration = length / kBlocks;
    const auto tenth =
        std::upper_bound(run.time.begin(), run.time.end(), begin + window->first_duration) - run.time.begin();
    window->first_speed = BlockSpeed(run, source, hold.first, static_cast<size_t>(tenth));
    if (stretch.has_value()) {
      result.steady.push_back(*window);
    } else if (!result.longest_unsteady.has_value() ||
               window->duration() > result.longest_unsteady->duration()) {
      result.longest_unsteady = window;
    }
  }
  double fastest = 0;
  for (const SpeedWindow& window : result.steady) fastest = std::max(fastest, std::abs(window.speed));
  std::erase_if(result.steady, [&](const SpeedWindow& window) {
    return !(std::abs(window.speed) > kSlowest * fastest) || window.speed * window.voltage <= 0;
  });
  return result;
}

}  // namespace hydro::experiments
