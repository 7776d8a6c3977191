#include "experiments/studies/torque_runs.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/runs/shipped_models.h"
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

constexpr double kReach = 0.1;            // rad
constexpr double kPointInterval = 0.005;  // s, of the path and of the command
// Speeds and accelerations of the unit quintic 10 s^3 - 15 s^4 + 6 s^5 peak at 15/8 and 5.77.
constexpr double kPeakRate = 1.875;

std::string Points(double duration, const auto& value) {
  std::string out;
  const auto count = static_cast<int>(std::lround(duration / kPointInterval));
  for (int i = 0; i <= count; ++i) {
    const double time = i * kPointInterval;
    out += fmt::format("{}[{}, {}]", i == 0 ? "" : ", ", time, value(time));
  }
  return "[" + out + "]";
}

// Solves k_1 (k_p e - k_p k_v w) = J theta'' + b theta' + T_s sgn(theta') + D (ref - e) for e. w is the pump
// speed that the k_v term sees; the higher side leaks (c_I + c_E) |dp| while the other is at p_3.
double PathError(const model::Parameters& p, const pressure_ctrl::PressureGains& gains, double reference,
                 double arm_speed, double arm_acceleration, bool arm_speed_feedforward) {
  const double forced = p.c / p.D * arm_speed;
  const double leak_per_psi = (p.c_I + p.c_E) / p.D;  // rad/s per psi
  const double gain = p.k_1 * gains.k_p;
  const double braking = gain * gains.k_v;
  const double seen = arm_speed_feedforward ? 0 : forced;
  const double turns = forced + leak_per_psi * reference;  // for the sign of friction
  const double friction = turns == 0 ? 0 : std::copysign(p.T_s, turns);
  const double torque = p.J * p.c / p.D * arm_acceleration + p.b * forced + friction + braking * seen;
  // leak_per_psi (ref - e) turns the pump as well, which adds b and the k_v term.
  const double per_psi = p.D + (p.b + braking) * leak_per_psi;
  return (torque + per_psi * reference) / (gain + per_psi);
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

SmoothPath::SmoothPath(double reach, double largest_speed)
    : reach_(reach),
      move_(std::round(kPeakRate * 2 * reach / largest_speed / (2 * kPointInterval)) * 2 * kPointInterval) {}

SmoothPath::Phase SmoothPath::At(double time) const {
  if (time < kRest) return {0, 0};
  if (time < kRest + move_) return {(time - kRest) / move_, 1};
  if (time < 2 * kRest + move_) return {1, 0};
  if (time < 2 * (kRest + move_)) return {1 - (time - 2 * kRest - move_) / move_, -1};
  return {0, 0};
}

double SmoothPath::angle(double time) const {
  const double s = At(time).share;
  return reach_ * (2 * s * s * s * (10 - 15 * s + 6 * s * s) - 1);
}

double SmoothPath::speed(double time) const {
  const Phase at = At(time);
  const double s = at.share;
  return at.direction * 2 * reach_ / move_ * 30 * s * s * (1 - s) * (1 - s);
}

double SmoothPath::acceleration(double time) const {
  const Phase at = At(time);
  const double s = at.share;
  // The way back is the way there in reversed time: the same acceleration at the same place.
  return std::abs(at.direction) * 2 * reach_ / (move_ * move_) * 60 * s * (1 - s) * (1 - 2 * s);
}

TorqueOnPath RunTorqueOnPath(const StackRunner& run_stack, double largest_speed, bool arm_speed_feedforward) {
  const model::Parameters p = PressureLoopParameters();
  const pressure_ctrl::PressureGains gains = PressureLoopGains();
  const double mgl = ShippedModel("table1_gravity").parameters.mgl;
  const SmoothPath path(kReach, largest_speed);
  const auto command = [&](double time) {
    return p.J_a * path.acceleration(time) + mgl * std::cos(path.angle(time));
  };
  TorqueOnPath out;
  out.largest_speed = path.speed(path.middle());
  out.arm_speed_feedforward = arm_speed_feedforward;
  const auto angle = [&](double time) { return path.angle(time); };
  out.run = RunPressureLoop(
      run_stack,
      {.name = fmt::format("torque-path-{}{}", largest_speed, arm_speed_feedforward ? "-feedforward" : ""),
       .reference =
           "signal = \"torque\"\nkind = \"csv\"\npoints = " + Points(path.duration(), command) + "\n",
       .duration = path.duration(),
       .arm_speed_feedforward = arm_speed_feedforward,
       .motion =
           "kind = \"csv\"\ninterpolation = \"cubic\"\npoints = " + Points(path.duration(), angle) + "\n"});

  double squares = 0;
  for (size_t i = 0; i < out.run.time.size(); ++i) {
    const double time = out.run.time[i];
    const double wanted = command(time);
    out.command.push_back(wanted);
    out.error.push_back(wanted - p.k_2 * out.run.dp[i]);
    out.closed_form.push_back(p.k_2 * PathError(p, gains, wanted / p.k_2, path.speed(time),
                                                path.acceleration(time), arm_speed_feedforward));
    // Only the torque along the path counts, not its initial rise.
    if (time < SmoothPath::kRest) continue;
    out.largest_motor_torque = std::max(out.largest_motor_torque, std::abs(out.run.torque[i]));
    out.largest_motor_speed = std::max(out.largest_motor_speed, std::abs(out.run.motor_speed[i]));
    out.largest_error = std::max(out.largest_error, std::abs(out.error[i]));
    squares += out.error[i] * out.error[i];
  }
  const auto middle = static_cast<size_t>(std::lround(path.middle() * kLoopRate));
  out.error_at_largest_speed = out.error[middle];
  out.closed_form_at_largest_speed = out.closed_form[middle];
  out.rms_error = std::sqrt(squares / ((path.duration() - SmoothPath::kRest) * kLoopRate));
  return out;
}

}  // namespace hydro::experiments
