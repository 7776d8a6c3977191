#include "tests/diagnose/balances/clean_runs.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/started_actuator.h"
#include "tests/diagnose/prepare_run.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {

namespace {

constexpr double kStep = 5e-4;  // s

double VoltageAt(const CleanRun& run, double t) {
  double voltage = run.sine * std::sin(2 * std::numbers::pi * (run.frequency + 0.5 * run.turn * t) * t);
  if (!run.levels.empty())
    voltage += run.levels[static_cast<size_t>(t / run.level_time + 1e-9) % run.levels.size()];
  return voltage;
}

}  // namespace

model::ModelDescription PlainMachine(std::vector<model::EffectDescription> effects) {
  model::ModelDescription machine = Table1With(std::move(effects));
  machine.parameters.T_s = 1;
  return machine;
}

std::vector<CleanRun> RichRuns() {
  return {{.name = "pressed",
           .arm_angle = 0.1,
           .pressure = 1500,
           .levels = {6, -4, 5, -6, 15, 2, -14, 3, -5, -16, 4},
           .level_time = 0.13,
           .sine = 3,
           .frequency = 2,
           .turn = 8},
          {.name = "held",
           .arm_angle = -0.3,
           .levels = {3, 6, -3, -7, 14, -6, 2, -15},
           .level_time = 0.17,
           .sine = 2,
           .frequency = 5},
          {.name = "free",
           .shaft = model::Shaft::kFree,
           .arm_angle = -0.2,
           .pressure = 1200,
           .levels = {4, -4, -6, 6, 14, -14, -2, 2},
           .level_time = 0.12,
           .sine = 2,
           .frequency = 3,
           .turn = 4},
          {.name = "bypass",
           .bypass = true,
           .pressure = 300,
           .levels = {4, -3, 7, -6, 14, 2, -15, -2},
           .level_time = 0.2,
           .sine = 2,
           .frequency = 3},
          {.name = "slow", .bypass = true, .pressure = 300, .sine = 0.6, .frequency = 1.2}};
}

runs::MeasuredRun Measure(const model::ModelDescription& truth, const CleanRun& how) {
  runs::MeasuredRun run;
  run.name = run.file = how.name;
  run.shaft = how.shaft;
  run.arm_angle_rad = how.arm_angle;
  run.bypass = how.bypass;
  model::ActuatorOptions options;
  options.shaft = how.shaft;
  options.arm_angle = how.arm_angle;
  options.bypass = how.bypass;
  // As a recording begins: an accumulator has filled the sides.
  const double pressure = std::max(how.pressure, truth.parameters.p_3);
  model::StartedActuator actuator(truth, options, {0, 0, pressure, pressure, how.arm_angle, 0}, 0);
  const auto samples = static_cast<size_t>(std::lround(how.duration / kStep));
  for (size_t k = 0; k < samples; ++k) {
    const double t = kStep * static_cast<double>(k);
    if (k > 0) actuator.Advance(run.voltage.values.back(), t);
    const model::Measurement m = actuator.Measure();
    run.time.push_back(t);
    run.voltage.values.push_back(VoltageAt(how, t));
    run.motor_speed.values.push_back(m.motor_speed);
    run.motor_angle.values.push_back(m.motor_angle);
    run.p1.values.push_back(m.p1);
    run.p2.values.push_back(m.p2);
    if (how.shaft == model::Shaft::kFree) run.arm_angle.values.push_back(m.arm_angle);
  }
  run.motor_speed.noise = 1e-3;
  run.motor_angle.noise = 1e-6;
  run.p1.noise = run.p2.noise = 1e-2;
  if (run.arm_angle.measured()) run.arm_angle.noise = 1e-7;
  return run;
}

std::vector<runs::MeasuredRun> MeasureAll(const model::ModelDescription& truth) {
  std::vector<runs::MeasuredRun> runs;
  for (const CleanRun& how : RichRuns()) {
    runs.push_back(Measure(truth, how));
    const std::vector<double>& angle = runs.back().motor_angle.values;
    if (angle.front() == angle.back() && *std::max_element(angle.begin(), angle.end()) == angle.front())
      runs.pop_back();
  }
  return runs;
}

std::vector<diagnose::RunData> Prepared(std::vector<runs::MeasuredRun> runs, const model::Parameters& given) {
  std::vector<diagnose::RunData> prepared;
  for (runs::MeasuredRun& run : runs) prepared.push_back(diagnose::PrepareRun(std::move(run), given));
  return prepared;
}

}  // namespace hydro::testing
