#include "tune/search/step_trial.h"

#include <algorithm>
#include <cmath>

#include "model/actuator.h"
#include "plant/simulated_rig.h"

namespace hydro::tune {

StepRun RunStepTrial(const StepTrial& trial) {
  model::Actuator actuator(trial.model, {.arm_angle = trial.start});
  design::StackLoops loops(trial, trial.start);
  const double full_torque = trial.model.parameters.T_pmax / trial.model.parameters.k_1;  // V
  const double full_voltage = std::min(trial.pressure.voltage_limit, full_torque) * (1 - 1e-9);
  StepRun run;
  const auto before = static_cast<int>(std::lround(trial.rest / trial.tick));
  const auto ticks = before + static_cast<int>(std::lround(trial.duration / trial.tick));
  const auto last_part = before + static_cast<int>((1 - kLastPart) * (ticks - before));
  run.response.time.reserve(static_cast<size_t>(ticks - before) + 1);
  run.response.angle.reserve(static_cast<size_t>(ticks - before) + 1);
  for (int k = 0; k <= ticks; ++k) {
    const model::Measurement now = actuator.Measure();
    if (k >= before) {
      run.response.time.push_back((k - before) * trial.tick);
      run.response.angle.push_back(now.arm_angle - trial.start);
    }
    run.highest_pressure = std::max({run.highest_pressure, now.p1, now.p2});
    run.highest_speed = std::max(run.highest_speed, std::fabs(now.motor_speed));
    const double reference = trial.start + (k < before ? 0 : trial.step);
    const double voltage = loops.Voltage(k, plant::ReadSensors(now, trial.noise, trial.seed, k), reference);
    const bool full = std::fabs(voltage) >= full_voltage, held_back = loops.held_back();
    if (k >= before) {
      run.saturated += full ? trial.tick : 0;
      run.held_back += held_back ? trial.tick : 0;
    }
    if (k >= last_part) {
      run.saturated_at_end += full ? trial.tick : 0;
      run.held_back_at_end += held_back ? trial.tick : 0;
    }
    actuator.Advance(voltage, (k + 1) * trial.tick);
  }
  return run;
}

StepTrial TrialOf(const settings::StackConfig& config) {
  StepTrial trial;
  trial.model = config.model.description;
  static_cast<design::LoopSettings&>(trial) = design::LoopSettingsFor(config);
  trial.signal = settings::ReferenceSignal::kArmAngle;
  trial.tick = 1 / config.plant.rate_hz;
  return trial;
}

}  // namespace hydro::tune
