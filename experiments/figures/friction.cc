// "Determining the System Parameters": T_s from the voltage at which the motor breaks away, then T_s and b
// from torque over steady speed with the two sides connected.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "base/maths/linear_fit.h"
#include "experiments/figures/catalogue.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/paper_units.h"
#include "experiments/studies/pump_friction.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

// The sensors of the simulated rig: a 14-bit encoder, and a noisy tachometer behind a converter.
constexpr double kEncoderStep = 2 * std::numbers::pi / 16384;  // rad
constexpr double kSpeedNoise = 0.3;                            // rad/s
constexpr double kSpeedStep = 0.1;                             // rad/s

// Voltages held in each direction, V: up to 550 of the motor's 628 rad/s (6000 rpm). Each hold lasts 15 time
// constants J/b.
constexpr double kVoltages[] = {1.25, 1.625, 2.0, 2.5, 3.0};
constexpr double kHold = 30;  // s

// The ramps: quickly to a voltage that certainly does not move the motor, then slowly further.
constexpr double kRampStart = 0.8;                                 // V
constexpr double kRampEnd = 1.1;                                   // V
constexpr double kRampTime = 15;                                   // s
constexpr double kLeadTime = 0.5;                                  // s, before the ramp starts
constexpr double kBackwardFrom = 20;                               // s
constexpr double kRampRate = (kRampEnd - kRampStart) / kRampTime;  // V/s
// A reading this far from rest counts as moved: five encoder steps, the last of which begins at its middle.
constexpr double kMoved = 4.5 * kEncoderStep;  // rad

std::string Config(double duration, const std::string& reference, int64_t seed) {
  return fmt::format(
      "[model]\nfile = \"table1.toml\"\nshaft = \"clamped\"\nbypass = true\n"
      "[time]\nmode = \"lockstep\"\nduration_s = {}\n"
      "[plant]\nrate_hz = 1000\n"
      "[pressure]\nk_p = 0.0\nk_v = 0.0\n"
      "[position]\nsample_interval_s = 0.001\n"
      "[reference]\nsignal = \"voltage\"\n{}"
      "[limits]\nmotor_speed = 628.3\n"
      "[noise]\nseed = {}\nmotor_speed = {}\nmotor_speed_resolution = {}\n"
      "motor_angle_resolution_rad = {}\n",
      duration, reference, seed, kSpeedNoise, kSpeedStep, kEncoderStep);
}

runs::MeasuredRun Measure(const ExperimentOptions& options, const std::string& name,
                          const std::string& config) {
  const std::string& model = ShippedModelText("table1");
  tables::Table table = options.run_stack({name, config, model});
  table.file = name;
  return runs::RunOfExport(table, config, model);
}

runs::MeasuredRun MeasureHolds(const ExperimentOptions& options) {
  std::string steps;
  double time = 0;
  for (const int sign : {1, -1}) {
    for (const double voltage : kVoltages) {
      steps += fmt::format("[{:.1f}, {}], ", time, sign * voltage);
      time += kHold;
    }
  }
  return Measure(options, "friction-holds",
                 Config(time, fmt::format("kind = \"steps\"\nsteps = [{}]\n", steps), options.seed));
}

runs::MeasuredRun MeasureRamps(const ExperimentOptions& options) {
  std::string points = "[0.0, 0.0], ";
  for (const double from : {0.0, kBackwardFrom}) {
    const int sign = from > 0 ? -1 : 1;
    if (from > 0) points += fmt::format("[{}, 0.0], [{}, 0.0], ", kLeadTime + kRampTime + 0.5, from);
    points += fmt::format("[{}, {}], [{}, {}], ", from + kLeadTime, sign * kRampStart,
                          from + kLeadTime + kRampTime, sign * kRampEnd);
  }
  return Measure(options, "friction-ramps",
                 Config(kBackwardFrom + kLeadTime + kRampTime,
                        fmt::format("kind = \"csv\"\npoints = [{}]\n", points), options.seed));
}

// "Contains" as text.
const char* Holds(const maths::Estimate& estimate, double truth) {
  return estimate.low <= truth && truth <= estimate.high ? "holds" : "misses";
}

// The largest torque, in-lbf, that acceleration can still take at any of the points, as far as the noise
// shows.
double AccelerationTorque(const PumpFriction& friction, const model::Parameters& p) {
  double most = 0;
  for (const FrictionPoint& point : friction.points) {
    most = std::max(most, p.J * point.window.LargestAcceleration());
  }
  return most;
}

// The largest remaining transient at any of the points, in-lbf; it widens the intervals.
double TransientTorque(const PumpFriction& friction) {
  double most = 0;
  for (const FrictionPoint& point : friction.points) most = std::max(most, point.transient);
  return most;
}

// The numbers that the points and lines give for the files, simulated or measured.
json FitNumbers(const PumpFriction& friction, const model::Parameters& p) {
  json numbers = {{"T_s", friction.T_s.value},
                  {"b", friction.b.value},
                  {"ci95", {{"T_s", IntervalJson(friction.T_s)}, {"b", IntervalJson(friction.b)}}},
                  {"units", {{"T_s", "in-lbf"}, {"b", "in-lbf-s"}}},
                  {"T_s_forward", friction.T_s_forward.value},
                  {"T_s_forward_ci95", IntervalJson(friction.T_s_forward)},
                  {"T_s_backward", friction.T_s_backward.value},
                  {"T_s_backward_ci95", IntervalJson(friction.T_s_backward)},
                  {"T_s_difference", friction.difference.value},
                  {"T_s_difference_ci95", IntervalJson(friction.difference)},
                  {"scatter_in_lbf", friction.scatter},
                  {"degrees_of_freedom", friction.degrees_of_freedom},
                  {"acceleration_may_take_in_lbf", AccelerationTorque(friction, p)},
                  {"transient_may_take_in_lbf", TransientTorque(friction)},
                  {"k_1", p.k_1}};
  for (const FrictionPoint& point : friction.points) {
    const SpeedWindow& window = point.window;
    numbers["points"].push_back({{"voltage_V", window.voltage},
                                 {"torque_in_lbf", point.torque},
                                 {"motor_speed_rad_s", window.speed},
                                 {"standard_error_rad_s", window.speed_error},
                                 {"from_s", window.from},
                                 {"to_s", window.to}});
  }
  return numbers;
}

std::vector<tables::Column> FitColumns(const PumpFriction& friction) {
  std::vector<tables::Column> columns = {{"from_s", {}},
                                         {"to_s", {}},
                                         {"voltage_V", {}},
                                         {"torque_in_lbf", {}},
                                         {"motor_speed_rad_s", {}},
                                         {"standard_error_rad_s", {}},
                                         {"acceleration_rad_s2", {}},
                                         {"fitted_torque_in_lbf", {}}};
  for (const FrictionPoint& point : friction.points) {
    const SpeedWindow& window = point.window;
    const double row[] = {window.from,  window.to,          window.voltage,      point.torque,
                          window.speed, window.speed_error, window.acceleration, point.fitted};
    for (size_t i = 0; i < columns.size(); ++i) columns[i].values.push_back(row[i]);
  }
  return columns;
}

// The line through the points of one direction.
page::Curve FittedLine(const PumpFriction& friction, double direction, double fastest) {
  const double intercept = (direction > 0 ? friction.T_s_forward : friction.T_s_backward).value;
  const double end = direction * 1.15 * fastest;
  return {.label = direction > 0 ? "b θ' + T_s, forward" : "b θ' - T_s, backward",
          .x = {0, end},
          .y = {direction * intercept, direction * intercept + friction.b.value * end},
          .colour = direction > 0 ? 1 : 2};
}

// Points minus lines, with the speeds' error bars converted to torques.
page::Panel ResidualsPanel(const PumpFriction& friction, const page::Axis& speed) {
  page::Curve residuals{.stroke = page::Stroke::kPoints, .colour = 0};
  for (const FrictionPoint& point : friction.points) {
    residuals.x.push_back(point.window.speed);
    // 95 %; ten blocks leave nine degrees of freedom.
    const double error = 1e3 * maths::StudentT95(9) * friction.b.value * point.window.speed_error;
    residuals.y.push_back(1e3 * (point.torque - point.fitted));
    residuals.y_low.push_back(residuals.y.back() - error);
    residuals.y_high.push_back(residuals.y.back() + error);
  }
  return {.title = "Points minus lines, with the 95 % error bars of the speeds",
          .x = speed,
          .y = {.label = "10^-3 in-lbf"},
          .curves = {residuals},
          .rules = {{"", false, 0}}};
}

Picture LinesPicture(const PumpFriction& friction, const std::string& conditions) {
  page::Curve points{.label = "steady states", .stroke = page::Stroke::kPoints, .colour = 0};
  double fastest = 0;
  for (const FrictionPoint& point : friction.points) {
    points.x.push_back(point.window.speed);
    points.y.push_back(point.torque);
    fastest = std::max(fastest, std::abs(point.window.speed));
  }
  const page::Axis speed{.label = "motor speed θ', rad/s", .min = -1.15 * fastest, .max = 1.15 * fastest};
  page::Panel torque{.title = "Torque against steady speed, both sides connected",
                     .x = speed,
                     .y = {.label = "T_p, in-lbf"},
                     .curves = {points, FittedLine(friction, 1, fastest), FittedLine(friction, -1, fastest)},
                     .notes = {{fmt::format("T_s = {}", maths::PlusMinus(friction.T_s_forward)), 0,
                                friction.T_s_forward.value},
                               {fmt::format("T_s = {}", maths::PlusMinus(friction.T_s_backward)), 0,
                                -friction.T_s_backward.value}},
                     .height = 2};
  return {"",
          {.caption = fmt::format("{} Slope b = {} in-lbf-s, intercepts T_s = {} in-lbf on average (95 %).",
                                  conditions, maths::PlusMinus(friction.b), maths::PlusMinus(friction.T_s)),
           .panels = {torque, ResidualsPanel(friction, speed)}}};
}

struct RampReading {
  double direction = 1;
  BreakAway moved;
  double torque = 0;  // in-lbf, magnitude at the first sample that has moved
};

RampReading ReadRamp(const runs::MeasuredRun& run, double from, const model::Parameters& p) {
  RampReading reading;
  reading.direction = from > 0 ? -1 : 1;
  const auto moved = FindBreakAway(run, from + kLeadTime, from + kLeadTime + kRampTime, kMoved);
  if (!moved.has_value()) throw std::runtime_error("friction: the motor did not break away on the ramp");
  reading.moved = *moved;
  reading.torque = std::abs(p.k_1 * moved->voltage);
  return reading;
}

Picture RampPicture(const runs::MeasuredRun& run, const std::vector<RampReading>& readings, double T_s,
                    const model::Parameters& p) {
  const double ramp = p.k_1 * kRampRate;
  page::Curve command{.x = run.time, .colour = 0};
  for (const double voltage : run.voltage.values) command.y.push_back(p.k_1 * voltage);
  page::Panel torque{
      .title = "The ramps", .x = {.label = "time, s"}, .y = {.label = "T_p, in-lbf"}, .curves = {command}};
  page::Panel angle{.title = "How far the motor has turned",
                    .x = {.label = "|T_p|, in-lbf", .min = T_s - 0.01, .max = T_s + 0.03},
                    .y = {.label = "angle from rest, 10^-3 rad", .min = 0, .max = 6},
                    .rules = {{"T_s", true, T_s}, {"counts as moved", false, 1e3 * kMoved}}};
  for (const RampReading& reading : readings) {
    torque.notes.push_back({fmt::format("moves at {:.4f} in-lbf", reading.torque), reading.moved.time,
                            reading.direction * reading.torque});
    page::Curve curve{.label = reading.direction > 0 ? "forward" : "backward",
                      .stroke = page::Stroke::kSteps,
                      .colour = reading.direction > 0 ? 1 : 2};
    double rest = std::nan("");
    for (size_t i = 0; i < run.samples(); ++i) {
      const double at = reading.direction * command.y[i];
      if (std::abs(run.time[i] - reading.moved.time) > 3 || at < T_s - 0.01 || at > T_s + 0.03) continue;
      if (std::isnan(rest)) rest = run.motor_angle.values[i];
      curve.x.push_back(at);
      curve.y.push_back(1e3 * std::abs(run.motor_angle.values[i] - rest));
    }
    angle.curves.push_back(curve);
  }
  page::Curve expected{.label = "(T_p - T_s)^3 / (6 J T_p'^2)", .stroke = page::Stroke::kDashed, .colour = 0};
  for (double excess = 0; excess < 0.03; excess += 5e-4) {
    expected.x.push_back(T_s + excess);
    expected.y.push_back(1e3 * std::pow(excess, 3) / (6 * p.J * ramp * ramp));
  }
  angle.curves.push_back(expected);
  return {"-ramp",
          {.caption = fmt::format(
               "Break-away: the torque rises by {:.3g} in-lbf/s until an encoder of {:.3g} rad per step has "
               "moved by five steps. The dashed line is what eq. (4) gives without viscous friction.",
               ramp, kEncoderStep),
           .panels = {torque, angle}}};
}

// The simulated rig, measured as the paper measured its own.
struct RigStudy {
  model::Parameters p;
  runs::MeasuredRun ramps;
  PumpFriction friction;
  PumpFriction by_angle;              // from the encoder's angles instead of the speeds
  std::vector<RampReading> readings;  // forward, backward
  double excess = 0;                  // in-lbf, added to T_s by the ramp before movement shows
};

RigStudy MeasureRig(const ExperimentOptions& options) {
  RigStudy study;
  study.p = ShippedModel("table1").parameters;
  const model::Parameters& p = study.p;
  study.ramps = MeasureRamps(options);
  options.progress(0.1);
  const runs::MeasuredRun holds = MeasureHolds(options);
  options.progress(0.9);
  study.friction = FitPumpFriction(holds, SpeedSource::kSpeed, p);
  study.by_angle = FitPumpFriction(holds, SpeedSource::kAngle, p);
  study.readings = {ReadRamp(study.ramps, 0, p), ReadRamp(study.ramps, kBackwardFrom, p)};
  study.excess = BreakAwayExcess(p.k_1 * kRampRate, p.J, kMoved);
  return study;
}

std::string Explanation(const RigStudy& study) {
  const model::Parameters& p = study.p;
  const PumpFriction& friction = study.friction;
  const double error_percent =
      100 * std::max(std::abs(friction.T_s.value / p.T_s - 1), std::abs(friction.b.value / p.b - 1));
  return fmt::format(
      "The lines give T_s = {T_s} in-lbf and b = {b} in-lbf-s (95 %, Student, {degrees} degrees of freedom), "
      "at most {error_percent:.2g} % from the simulated rig's own. The intervals rest on the scatter of "
      "{holds} holds about the lines and on the remaining transients, at most {transient:.2g} in-lbf. The "
      "ramp reads {forward:.4f} in-lbf forward and {backward:.4f} backward, {forward_percent:.2g} and "
      "{backward_percent:.2g} % above T_s: the motor must turn by {moved:.2g} rad before it is seen to move, "
      "and a torque that rises by {rise:.3g} in-lbf/s has grown by (6 J θ T_p'^2)^{{1/3}} = {excess:.3g} "
      "in-lbf by then. From the encoder's angles instead of the speeds: T_s = {angle_T_s:.6f} in-lbf, b = "
      "{angle_b:.8f} in-lbf-s. The speed settles with the time constant J/b = {time_constant:.2f} s, so the "
      "holds are long.",
      fmt::arg("T_s", maths::PlusMinus(friction.T_s)), fmt::arg("b", maths::PlusMinus(friction.b)),
      fmt::arg("degrees", friction.degrees_of_freedom), fmt::arg("error_percent", error_percent),
      fmt::arg("holds", friction.points.size()), fmt::arg("transient", TransientTorque(friction)),
      fmt::arg("forward", study.readings[0].torque), fmt::arg("backward", study.readings[1].torque),
      fmt::arg("forward_percent", 100 * (study.readings[0].torque / p.T_s - 1)),
      fmt::arg("backward_percent", 100 * (study.readings[1].torque / p.T_s - 1)), fmt::arg("moved", kMoved),
      fmt::arg("rise", p.k_1 * kRampRate), fmt::arg("excess", study.excess),
      fmt::arg("angle_T_s", study.by_angle.T_s.value), fmt::arg("angle_b", study.by_angle.b.value),
      fmt::arg("time_constant", p.J / p.b));
}

std::vector<Comparison> Comparisons(const RigStudy& study) {
  const model::Parameters& p = study.p;
  const PumpFriction& friction = study.friction;
  return {
      {"T_s, intercept", "in-lbf", "4.0", p.T_s, friction.T_s.value,
       fmt::format("+/- {:.2g}: the interval {} the rig's own", friction.T_s.high - friction.T_s.value,
                   Holds(friction.T_s, p.T_s))},
      {"b, slope", "in-lbf-s", "0.01455", p.b, friction.b.value,
       fmt::format("+/- {:.2g}: the interval {} the rig's own", friction.b.high - friction.b.value,
                   Holds(friction.b, p.b))},
      {"break-away torque, forward", "in-lbf", "4.0", p.T_s + study.excess, study.readings[0].torque,
       "expected: T_s and what the ramp adds until motion is seen"},
      {"break-away torque, backward", "in-lbf", "4.0", p.T_s + study.excess, study.readings[1].torque, ""},
      {"time constant J/b", "s", "", p.J / p.b, p.J / friction.b.value, "how long to wait for steady speed"}};
}

json Numbers(const RigStudy& study) {
  const model::Parameters& p = study.p;
  json numbers = FitNumbers(study.friction, p);
  numbers["source"] = "simulated rig";
  numbers["from_encoder"] = {{"T_s", study.by_angle.T_s.value},
                             {"b", study.by_angle.b.value},
                             {"acceleration_may_take_in_lbf", AccelerationTorque(study.by_angle, p)}};
  numbers["break_away"] = {{"forward_in_lbf", study.readings[0].torque},
                           {"backward_in_lbf", study.readings[1].torque},
                           {"ramp_in_lbf_s", p.k_1 * kRampRate},
                           {"counts_as_moved_rad", kMoved},
                           {"expected_excess_in_lbf", study.excess}};
  return numbers;
}

ExperimentResult AnalyseMeasured(const ExperimentOptions& options) {
  const auto& [run, model] = ReadRunAndModel(options.measured_run);
  const model::Parameters p = PaperParameters(model);
  const SpeedSource source = SpeedSourceOf(run);
  const PumpFriction friction = FitPumpFriction(run, source, p);
  ExperimentResult result;
  result.conditions = fmt::format(
      "Measured run {}, bypass open, speed from the motor's {}; k_1 = {:.6g} in-lbf/V is that of the model "
      "\"{}\".",
      NameWithCaution(run), source == SpeedSource::kSpeed ? "speed" : "angle", p.k_1, model.name);
  result.paper_says =
      "With a valve open between the two sides, constant voltages held to steady speed give T_p against "
      "speed; the slope is b, the intercept T_s.";
  result.explanation = fmt::format(
      "{} steady states were found; the points scatter by {:.3g} in-lbf about the lines, and remaining "
      "transients take at most {:.2g} in-lbf from one: the intervals include both. The Coulomb frictions of "
      "the two directions differ by {} in-lbf. Both values are in proportion to k_1.",
      friction.points.size(), friction.scatter, TransientTorque(friction),
      maths::PlusMinus(friction.difference));
  json numbers = FitNumbers(friction, p);
  numbers["source"] = run.file;
  numbers["model"] = model.name;
  result.numbers = JsonText(numbers);
  result.table.columns = FitColumns(friction);
  result.pictures = {LinesPicture(friction, result.conditions)};
  result.comparisons = {{"T_s", "in-lbf", "", page::kAutomatic, friction.T_s.value,
                         maths::PlusMinus(friction.T_s) + " in-lbf, 95 %"},
                        {"b", "in-lbf-s", "", page::kAutomatic, friction.b.value,
                         maths::PlusMinus(friction.b) + " in-lbf-s, 95 %"}};
  return result;
}

}  // namespace

ExperimentResult RunFriction(const ExperimentOptions& options) {
  if (!options.measured_run.empty()) return AnalyseMeasured(options);
  const RigStudy study = MeasureRig(options);
  ExperimentResult result;
  result.conditions = fmt::format(
      "Table 1 with the bypass open (p_1 = p_2), over the stack at 1 kHz. Speed read with {} rad/s of noise "
      "in steps of {} rad/s, angle in steps of {:.3g} rad. {} voltages of each sign, held {} s each.",
      kSpeedNoise, kSpeedStep, kEncoderStep, std::size(kVoltages), kHold);
  result.paper_says =
      "T_s is the torque of the smallest voltage that turns the motor. Then, with a valve open between the "
      "two sides, constant voltages are held to steady speed and T_p is plotted against speed: the slope is "
      "b, the intercept a check of T_s.";
  result.explanation = Explanation(study);
  result.numbers = JsonText(Numbers(study));
  result.comparisons = Comparisons(study);
  result.table.columns = FitColumns(study.friction);
  result.pictures = {LinesPicture(study.friction, result.conditions),
                     RampPicture(study.ramps, study.readings, study.p.T_s, study.p)};
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
