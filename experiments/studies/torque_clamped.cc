#include "experiments/studies/torque_clamped.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runs/step_response.h"

namespace hydro::experiments {
namespace {

constexpr double kStepDuration = 1.5;  // s
constexpr double kSweepDuration = 12;  // s
constexpr double kRest = 1;            // s, before a sweep
constexpr double kAtMean = 0.6;        // s; from here on the torque rests at its mean

// The first time at which `values` reach `level`, interpolated linearly between samples.
double FirstTimeAt(const std::vector<double>& times, const std::vector<double>& values, double level) {
  for (size_t i = 1; i < times.size(); ++i) {
    if (values[i] < level) continue;
    const double share = (level - values[i - 1]) / (values[i] - values[i - 1]);
    return times[i - 1] + share * (times[i] - times[i - 1]);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> Scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

}  // namespace

TorqueStep RunTorqueStep(const StackRunner& run_stack, double command, double feedforward) {
  const model::Parameters p = PressureLoopParameters();
  TorqueStep step;
  step.command = command;
  step.run = RunPressureLoop(
      run_stack,
      {.name = fmt::format("torque-step-{}{}", command, feedforward == 0 ? "" : "-feedforward"),
       .reference = fmt::format("signal = \"torque\"\nkind = \"steps\"\nsteps = [[0, {}]]\n", command),
       .duration = kStepDuration,
       .feedforward = feedforward,
       .motion = ""});
  const std::vector<double> torque = Scaled(step.run.dp, p.k_2);
  step.error = p.k_2 * MeanError(step.run, kStepDuration);
  const double reference = command / p.k_2;
  step.closed_form_error = command - p.k_2 * SettledPressure(reference, feedforward);
  const double settled = command - step.error;
  step.rise_time =
      FirstTimeAt(step.run.time, torque, 0.9 * settled) - FirstTimeAt(step.run.time, torque, 0.1 * settled);
  step.overshoot_percent =
      runs::MeasureStep(step.run.time, torque, 0, torque.size(), 0, command).overshoot_percent;
  step.settling_time = runs::MeasureStep(step.run.time, torque, 0, torque.size(), 0, settled).settling_time_s;
  const double limit = p.T_pmax;
  size_t saturated = 0, early = 0;
  for (; early < step.run.time.size() && step.run.time[early] < 0.1; ++early) {
    if (std::abs(step.run.torque[early]) >= limit) ++saturated;
  }
  step.saturated_fraction = static_cast<double>(saturated) / static_cast<double>(early);
  return step;
}

TorqueSweep RunTorqueSweep(const StackRunner& run_stack, double mean, double amplitude) {
  const model::Parameters p = PressureLoopParameters();
  TorqueSweep sweep;
  sweep.mean = mean;
  sweep.amplitude = amplitude;
  const PressureLoopRun run = RunPressureLoop(
      run_stack,
      {.name = fmt::format("torque-sweep-{}-{}", mean, amplitude),
       .reference = fmt::format("signal = \"torque\"\nkind = \"chirp\"\noffset = {}\namplitude = {}\n"
                                "first_frequency_hz = {}\nlast_frequency_hz = {}\nstart_s = {}\n"
                                "duration_s = {}\n",
                                mean, amplitude, kSweepFirst, kSweepLast, kRest, kSweepDuration),
       .duration = kRest + kSweepDuration,
       .motion = ""});
  std::vector<double> commanded, torque;
  size_t saturated = 0, both = 0;
  for (size_t i = 0; i < run.time.size(); ++i) {
    if (run.time[i] < kAtMean || std::isnan(run.reference[i])) continue;
    commanded.push_back(p.k_2 * run.reference[i]);
    torque.push_back(p.k_2 * run.dp[i]);
    if (run.time[i] < kRest) continue;
    saturated += std::abs(run.torque[i]) >= p.T_pmax;
    both += run.p1[i] > p.p_3 && run.p2[i] > p.p_3;
  }
  sweep.saturated_fraction = static_cast<double>(saturated) / (kSweepDuration * kLoopRate);
  sweep.both_compress_fraction = static_cast<double>(both) / (kSweepDuration * kLoopRate);
  sweep.points = design::EstimateFrequencyResponse(
      commanded, torque,
      {.sample_rate_hz = kLoopRate, .segment_s = 1, .first_hz = 2, .last_hz = kSweepLast - 5});
  sweep.bandwidth_hz = design::BandwidthHz(sweep.points, std::abs(sweep.points.front().gain));
  return sweep;
}

double FrictionBandTorque() {
  const FrictionBand band = StickingPressures(0, 0);
  return PressureLoopParameters().k_2 * (band.high - band.low) / 2;
}

// |G|^2 = 1/2 of a second-order low-pass.
double LinearBandwidthHz(int compressed_sides) {
  const pressure_ctrl::SecondOrder loop =
      pressure_ctrl::PressureLoopDynamics(PressureLoopParameters(), 0, PressureLoopGains(), compressed_sides);
  const double a = 1 - 2 * loop.damping_ratio * loop.damping_ratio;
  return loop.natural_frequency * std::sqrt(a + std::sqrt(a * a + 1)) / (2 * std::numbers::pi);
}

}  // namespace hydro::experiments
