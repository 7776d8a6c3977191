// Torque control, the paper's stated purpose: a commanded torque against a clamped arm and along a path.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/figures/catalogue.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/torque_runs.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kPathSpeed = 0.15;  // rad/s, the peak speed along the path in the picture

struct Study {
  double feedforward = 0;  // V/psi, of the reference
  std::vector<TorqueStep> steps, steps_with;
  std::vector<TorqueSweep> sweeps;
  std::vector<TorqueOnPath> paths, paths_with;

  const TorqueOnPath& pictured(bool with) const {
    const std::vector<TorqueOnPath>& all = with ? paths_with : paths;
    return *std::min_element(all.begin(), all.end(), [](const TorqueOnPath& a, const TorqueOnPath& b) {
      return std::abs(a.largest_speed - kPathSpeed) < std::abs(b.largest_speed - kPathSpeed);
    });
  }
};

Study RunTorqueStudy(const ExperimentOptions& options) {
  Study study;
  study.feedforward = pressure_ctrl::SteadyStateFeedforward(PressureLoopParameters(), PressureLoopGains());
  for (const double command : {200.0, 1000.0, 3000.0, 5000.0}) {
    study.steps.push_back(RunTorqueStep(options.run_stack, command, 0));
    study.steps_with.push_back(RunTorqueStep(options.run_stack, command, study.feedforward));
  }
  options.progress(0.2);
  struct Sweep {
    double mean, amplitude;
  };
  const std::vector<Sweep> sweeps = {{0, 100}, {0, 300}, {0, 1000}, {0, 3000}, {3000, 300}};
  for (const Sweep& sweep : sweeps) {
    study.sweeps.push_back(RunTorqueSweep(options.run_stack, sweep.mean, sweep.amplitude));
    options.progress(0.2 + 0.1 * static_cast<double>(study.sweeps.size()));
  }
  // Above 0.3 rad/s, the k_v term alone would drive the pressure to the seals' limit.
  for (const double speed : {0.05, kPathSpeed, 0.3}) {
    study.paths.push_back(RunTorqueOnPath(options.run_stack, speed, false));
  }
  for (const double speed : {0.05, kPathSpeed, 0.3, 0.5}) {
    study.paths_with.push_back(RunTorqueOnPath(options.run_stack, speed, true));
  }
  options.progress(0.9);
  return study;
}

json StepsJson(const std::vector<TorqueStep>& steps) {
  json out = json::array();
  for (const TorqueStep& step : steps) {
    out.push_back({{"command_in_lbf", step.command},
                   {"steady_state_error_in_lbf", step.error},
                   {"closed_form_error_in_lbf", step.closed_form_error},
                   {"rise_time_s", step.rise_time},
                   {"overshoot_percent", step.overshoot_percent},
                   {"settling_time_s", step.settling_time ? json(*step.settling_time) : json()},
                   {"saturated_fraction_of_first_100_ms", step.saturated_fraction}});
  }
  return out;
}

json PathsJson(const std::vector<TorqueOnPath>& paths) {
  json out = json::array();
  for (const TorqueOnPath& path : paths) {
    out.push_back({{"largest_arm_speed_rad_s", path.largest_speed},
                   {"largest_error_in_lbf", path.largest_error},
                   {"rms_error_in_lbf", path.rms_error},
                   {"error_at_largest_speed_in_lbf", path.error_at_largest_speed},
                   {"closed_form_error_at_largest_speed_in_lbf", path.closed_form_at_largest_speed},
                   {"largest_motor_torque_in_lbf", path.largest_motor_torque},
                   {"largest_motor_speed_rad_s", path.largest_motor_speed}});
  }
  return out;
}

std::string SweepName(const TorqueSweep& sweep) {
  return sweep.mean == 0 ? fmt::format("±{} in-lbf", sweep.amplitude)
                         : fmt::format("{} ± {} in-lbf", sweep.mean, sweep.amplitude);
}

Picture StepPicture(const Study& study) {
  constexpr double kUntil = 0.3;
  const double k_2 = PressureLoopParameters().k_2;
  page::Panel response{.title = "Torque at the clamped arm after a step of the command",
                       .x = {.label = "time, s", .min = 0, .max = kUntil},
                       .y = {.label = "torque / command", .min = 0},
                       .rules = {{"command", false, 1}},
                       .height = 1.4};
  page::Panel motor{.title = "Motor torque",
                    .x = response.x,
                    .y = {.label = "T_p, in-lbf", .min = -50, .max = 50},
                    .rules = {{"T_pmax", false, PressureLoopParameters().T_pmax},
                              {"", false, -PressureLoopParameters().T_pmax}}};
  int colour = 0;
  for (const TorqueStep& step : study.steps) {
    std::vector<double> share = step.run.dp;
    for (double& value : share) value *= k_2 / step.command;
    const std::string label = fmt::format("{} in-lbf", step.command);
    response.curves.push_back(SignalCurve(label, step.run, share, colour, kUntil));
    motor.curves.push_back(SignalCurve(label, step.run, step.run.torque, colour, kUntil));
    ++colour;
  }
  return {
      "",
      {.caption = "Torque commanded to the arm clamped at α = 0, from rest, eq. (16) without feed-forward.",
       .panels = {response, motor}}};
}

Picture BandwidthPicture(const Study& study) {
  const page::Axis frequency{.label = "frequency, Hz", .logarithmic = true, .min = 2, .max = 60};
  page::Panel gain{
      .title = "Torque at the clamped arm per commanded torque",
      .x = frequency,
      .y = {.label = "gain, dB", .min = -30, .max = 5},
      .rules = {{"-3 dB of the command", false, -3},
                {fmt::format("linear, both sides: {:.1f} Hz", LinearBandwidthHz(2)), true,
                 LinearBandwidthHz(2)},
                {fmt::format("one side: {:.1f}", LinearBandwidthHz(1)), true, LinearBandwidthHz(1)}},
      .height = 1.5};
  page::Panel coherence{.title = "Coherence",
                        .x = frequency,
                        .y = {.label = "coherence", .min = 0, .max = 1.05},
                        .height = 0.7};
  for (const TorqueSweep& sweep : study.sweeps) {
    page::Curve gains{.label = SweepName(sweep)};
    page::Curve coherences = gains;
    for (const design::ResponsePoint& point : sweep.points) {
      gains.x.push_back(point.frequency_hz);
      gains.y.push_back(design::Decibels(point.gain));
      coherences.x.push_back(point.frequency_hz);
      coherences.y.push_back(point.coherence);
    }
    gain.curves.push_back(std::move(gains));
    coherence.curves.push_back(std::move(coherences));
  }
  return {"-bandwidth",
          {.caption = fmt::format(
               "Swept sines of the commanded torque, {} to {} Hz, arm clamped at α = 0. Bandwidths are where "
               "the gain is 3 dB below that at the lowest frequency.",
               kSweepFirst, kSweepLast),
           .panels = {gain, coherence}}};
}

Picture PathPicture(const Study& study) {
  const TorqueOnPath& without = study.pictured(false);
  const TorqueOnPath& with = study.pictured(true);
  const double end = without.run.time.back();
  const page::Axis time{.label = "time, s", .min = 0, .max = end};
  const double k_2 = PressureLoopParameters().k_2;
  const auto torque = [&](const TorqueOnPath& path) {
    std::vector<double> values = path.run.dp;
    for (double& value : values) value *= k_2;
    return values;
  };
  const auto expected = [&](const TorqueOnPath& path) {
    std::vector<double> values = path.command;
    for (size_t i = 0; i < values.size(); ++i) values[i] -= path.closed_form[i];
    return values;
  };
  page::Panel angle{.title = "The arm is moved",
                    .x = time,
                    .y = {.label = "α, rad"},
                    .curves = {SignalCurve("", without.run, without.run.arm_angle, 0, end)},
                    .height = 0.6};
  page::Panel arm{
      .title = "Torque at the arm",
      .x = time,
      .y = {.label = "torque, in-lbf"},
      .curves = {SignalCurve("command", without.run, without.command, 5, end, page::Stroke::kDashed),
                 SignalCurve("eq. (16)", without.run, torque(without), 0, end),
                 SignalCurve("with arm-speed feed-forward", with.run, torque(with), 1, end),
                 SignalCurve("closed form of both", without.run, expected(without), 3, end,
                             page::Stroke::kDotted),
                 SignalCurve("", with.run, expected(with), 3, end, page::Stroke::kDotted)},
      .height = 1.3};
  page::Panel error{
      .title = "Torque error with arm-speed feed-forward",
      .x = time,
      .y = {.label = "command - torque, in-lbf", .min = -80, .max = 80},
      .curves = {SignalCurve("run", with.run, with.error, 1, end),
                 SignalCurve("closed form", with.run, with.closed_form, 3, end, page::Stroke::kDotted)}};
  return {"-path",
          {.caption = fmt::format("The arm is moved from -0.1 to 0.1 rad and back at up to {:.2f} rad/s "
                                  "while the torque that carries it there is commanded.",
                                  with.largest_speed),
           .panels = {angle, arm, error}}};
}

Picture SpeedPicture(const Study& study) {
  page::Panel panel{
      .title = "Largest torque error along the path",
      .x = {.label = "largest speed of the arm, rad/s", .logarithmic = true, .min = 0.04, .max = 0.6},
      .y = {.label = "error, in-lbf", .logarithmic = true},
      .rules = {{"friction band", false, FrictionBandTorque()}}};
  for (const bool with : {false, true}) {
    page::Curve curve{.label = with ? "with arm-speed feed-forward" : "eq. (16)",
                      .stroke = page::Stroke::kLinePoints};
    for (const TorqueOnPath& path : with ? study.paths_with : study.paths) {
      curve.x.push_back(path.largest_speed);
      curve.y.push_back(path.largest_error);
    }
    panel.curves.push_back(std::move(curve));
  }
  return {"-speed", {.caption = "The same path at several speeds.", .panels = {panel}}};
}

json Numbers(const Study& study) {
  json sweeps = json::array();
  for (const TorqueSweep& sweep : study.sweeps) {
    double least = 1;
    for (const design::ResponsePoint& point : sweep.points) least = std::min(least, point.coherence);
    sweeps.push_back({{"mean_in_lbf", sweep.mean},
                      {"amplitude_in_lbf", sweep.amplitude},
                      {"bandwidth_hz", std::isnan(sweep.bandwidth_hz) ? json() : json(sweep.bandwidth_hz)},
                      {"gain_at_lowest_point", std::abs(sweep.points.front().gain)},
                      {"saturated_fraction", sweep.saturated_fraction},
                      {"both_compress_fraction", sweep.both_compress_fraction},
                      {"least_coherence", least}});
  }
  return {{"friction_band_in_lbf", FrictionBandTorque()},
          {"clamped",
           {{"steps", StepsJson(study.steps)},
            {"steps_with_feedforward", StepsJson(study.steps_with)},
            {"feedforward_V_per_psi", study.feedforward},
            {"sweeps", sweeps},
            {"linear_bandwidth_both_sides_hz", LinearBandwidthHz(2)},
            {"linear_bandwidth_one_side_hz", LinearBandwidthHz(1)}}},
          {"along_path",
           {{"without_arm_speed_feedforward", PathsJson(study.paths)},
            {"with_arm_speed_feedforward", PathsJson(study.paths_with)}}}};
}

std::string ClampedText(const Study& study) {
  const TorqueStep& step = study.steps.at(1);
  const TorqueStep& large = study.steps.back();
  const TorqueSweep& small_sweep = study.sweeps.at(1);
  const TorqueSweep& large_sweep = study.sweeps.at(3);
  const TorqueSweep& held_sweep = study.sweeps.at(4);
  return fmt::format(
      "With the arm clamped, the loop keeps that promise. A step of {step} in-lbf rises (10 to 90 %) in "
      "{rise_ms:.0f} ms and settles {error:.1f} in-lbf short ({error_with:.1f} with the feed-forward); a "
      "step of {large_step} takes {large_rise_ms:.0f} ms, because the motor is at its limit. Friction keeps "
      "a pump at rest anywhere within ±{friction_band:.1f} in-lbf of its balance. The bandwidth at the arm "
      "is {small_bandwidth:.1f} Hz for ±{small_amplitude} in-lbf and {large_bandwidth:.1f} for "
      "±{large_amplitude}, where the motor is at its limit {saturated_percent:.0f} % of the time. For "
      "{held_mean} ± {held_amplitude} in-lbf it is {held_bandwidth:.1f}: one side held at p_3 would give "
      "{one_side_bandwidth:.1f}, but the valve lets fluid in within a cycle, and for {both_percent:.0f} % of "
      "the time both sides compress. ",
      fmt::arg("step", step.command), fmt::arg("rise_ms", 1e3 * step.rise_time),
      fmt::arg("error", step.error), fmt::arg("error_with", study.steps_with.at(1).error),
      fmt::arg("large_step", large.command), fmt::arg("large_rise_ms", 1e3 * large.rise_time),
      fmt::arg("friction_band", FrictionBandTorque()), fmt::arg("small_bandwidth", small_sweep.bandwidth_hz),
      fmt::arg("small_amplitude", small_sweep.amplitude),
      fmt::arg("large_bandwidth", large_sweep.bandwidth_hz),
      fmt::arg("large_amplitude", large_sweep.amplitude),
      fmt::arg("saturated_percent", 100 * large_sweep.saturated_fraction),
      fmt::arg("held_mean", held_sweep.mean), fmt::arg("held_amplitude", held_sweep.amplitude),
      fmt::arg("held_bandwidth", held_sweep.bandwidth_hz),
      fmt::arg("one_side_bandwidth", LinearBandwidthHz(1)),
      fmt::arg("both_percent", 100 * held_sweep.both_compress_fraction));
}

std::string PathText(const Study& study) {
  const model::Parameters p = PressureLoopParameters();
  const TorqueOnPath& without = study.pictured(false);
  const TorqueOnPath& with = study.pictured(true);
  const TorqueOnPath& fastest = study.paths_with.back();
  const double braking = p.k_2 * PressureLoopGains().k_v * p.c / p.D;  // in-lbf per rad/s of the arm
  return fmt::format(
      "Along a path, eq. (16) as printed fails: moving the arm turns the pump at (c/D) α', which the k_v "
      "term brakes with {braking:.0f} in-lbf per rad/s of the arm. At {speed:.2f} rad/s the error is "
      "{error:.0f} in-lbf, of {commanded:.0f} commanded. Taking that forced speed out of the k_v term "
      "(pressure.arm_speed_feedforward) leaves at most {error_with:.0f} along the whole path: friction, "
      "viscous drag and D dp, which the loop pays for with an error, and the pump's inertia where the arm "
      "accelerates. At {fastest_speed:.2f} rad/s that inertia takes the motor to {motor_torque:.1f} of its "
      "{torque_limit} in-lbf and the error to {fastest_error:.0f}.",
      fmt::arg("braking", braking), fmt::arg("speed", without.largest_speed),
      fmt::arg("error", without.error_at_largest_speed), fmt::arg("commanded", without.command.front()),
      fmt::arg("error_with", with.largest_error), fmt::arg("fastest_speed", fastest.largest_speed),
      fmt::arg("motor_torque", fastest.largest_motor_torque), fmt::arg("torque_limit", p.T_pmax),
      fmt::arg("fastest_error", fastest.largest_error));
}

std::vector<Comparison> Comparisons(const Study& study) {
  std::vector<Comparison> comparisons;
  for (const TorqueStep& s : study.steps) {
    comparisons.push_back({fmt::format("steady-state error at {} in-lbf, clamped", s.command), "in-lbf", "",
                           s.closed_form_error, s.error, "expected: balance of eqs. (4) and (16)"});
  }
  for (const TorqueStep& s : study.steps_with) {
    if (s.command != study.steps.at(1).command) continue;
    comparisons.push_back({fmt::format("the same at {} in-lbf with feed-forward", s.command), "in-lbf",
                           "could be eliminated", s.closed_form_error, s.error, "left is friction"});
  }
  for (const TorqueSweep& sweep : study.sweeps) {
    comparisons.push_back({"bandwidth at the arm, " + SweepName(sweep), "Hz", "about 32",
                           LinearBandwidthHz(2), sweep.bandwidth_hz,
                           fmt::format("expected: linear, both sides compress ({:.0f} % of the time here; "
                                       "one side: {:.1f} Hz); at the torque limit {:.0f} % of the time",
                                       100 * sweep.both_compress_fraction, LinearBandwidthHz(1),
                                       100 * sweep.saturated_fraction)});
  }
  for (const TorqueOnPath* path : {&study.pictured(false), &study.pictured(true)}) {
    comparisons.push_back({fmt::format("torque error at {:.2f} rad/s {} arm-speed feed-forward",
                                       path->largest_speed, path->arm_speed_feedforward ? "with" : "without"),
                           "in-lbf", "", path->closed_form_at_largest_speed, path->error_at_largest_speed,
                           "expected: eqs. (4) and (16) with the pump speed that the motion forces"});
  }
  return comparisons;
}

std::vector<tables::Column> Columns(const Study& study) {
  const double k_2 = PressureLoopParameters().k_2;
  const TorqueOnPath& without = study.pictured(false);
  const TorqueOnPath& with = study.pictured(true);
  std::vector<double> torque = without.run.dp, torque_with = with.run.dp;
  for (double& value : torque) value *= k_2;
  for (double& value : torque_with) value *= k_2;
  std::vector<tables::Column> columns = {{"time_s", without.run.time},
                                         {"arm_angle_rad", without.run.arm_angle},
                                         {"arm_speed_rad_s", without.run.arm_speed},
                                         {"torque_command_in_lbf", without.command},
                                         {"torque_in_lbf", torque},
                                         {"motor_torque_in_lbf", without.run.torque},
                                         {"torque_with_arm_speed_feedforward_in_lbf", torque_with},
                                         {"motor_torque_with_arm_speed_feedforward_in_lbf", with.run.torque}};
  for (tables::Column& column : columns) {  // 1 ms steps are enough here
    std::vector<double> thinned;
    for (size_t i = 0; i < column.values.size(); i += 5) thinned.push_back(column.values[i]);
    column.values = std::move(thinned);
  }
  return columns;
}

}  // namespace

ExperimentResult RunTorque(const ExperimentOptions& options) {
  const Study study = RunTorqueStudy(options);
  const pressure_ctrl::PressureGains gains = PressureLoopGains();
  ExperimentResult result;
  result.conditions = fmt::format(
      "Table 1, eq. (16) over the stack at {} Hz without delay, k_p = {:.4f} V/psi, k_v = {:.2f} psi s/rad; "
      "torque commands go to it as dp_ref = torque/k_2. Clamped: α = 0. Along a path: the arm is moved from "
      "-0.1 to 0.1 rad and back (quintic), and the torque commanded is J_a α'' + m g l cos α with m g l = {} "
      "in-lbf (assumed, the shipped gravity model). Bandwidth: 3 dB below the gain at the lowest frequency.",
      kLoopRate, gains.k_p, gains.k_v, ShippedModel("table1_gravity").parameters.mgl);
  result.paper_says =
      "Torque control is needed to exert a given force or to make an arm follow a trajectory; the pressure "
      "loop drives the torque quickly to the desired value, with a bandwidth of about 32 Hz.";
  result.explanation = ClampedText(study) + PathText(study);
  result.comparisons = Comparisons(study);
  result.numbers = JsonText(Numbers(study));
  result.table.columns = Columns(study);
  result.pictures = {StepPicture(study), BandwidthPicture(study), PathPicture(study), SpeedPicture(study)};
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
