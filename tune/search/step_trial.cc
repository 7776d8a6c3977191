#include "tune/search/step_trial.h"

#include <algorithm>
#include <cmath>

#include "model/actuator.h"
#include "plant/simulated_rig.h"
#include "tune/design/configured_laws.h"

namespace hydro::tune {
namespace {

// The two loops, from a reading of the sensors to the next voltage.
class Loops {
 public:
  explicit Loops(const StepTrial& trial) : trial_(trial), position_(trial.position) {
    // The history of the law before the step: the arm is at rest at its start.
    position_.Update(trial.start, trial.start, 1);
  }

  // The voltage that acts from tick k on.
  double Voltage(int k, const model::Measurement& m, double reference) {
    if (trial_.command_delay > 0) {
      voltage_ = next_voltage_;
      input_.pressure_ref = next_pressure_ref_;
    }
    if (k % trial_.interval == 0) {
      if (trial_.curve) reference = trial_.curve->Reference(m.arm_angle, reference);
      next_pressure_ref_ = position_ctrl::QuantiseDac(position_.Update(m.arm_angle, reference, 1),
                                                      trial_.dac_bits, trial_.dac_range);
    }
    if (trial_.command_delay == 0) input_.pressure_ref = next_pressure_ref_;
    if (k % trial_.pressure_interval == 0) {
      input_.p1 = m.p1;
      input_.p2 = m.p2;
      input_.motor_speed = m.motor_speed;
      input_.arm_speed = m.arm_speed;
      next_voltage_ = pressure_ctrl::PressureLaw(trial_.pressure, input_).voltage;
    }
    if (trial_.command_delay == 0) voltage_ = next_voltage_;
    return voltage_;
  }

 private:
  const StepTrial& trial_;
  position_ctrl::PositionLaw position_;
  pressure_ctrl::PressureLawInput input_;
  double next_pressure_ref_ = 0;  // computed, not yet in force
  double voltage_ = 0;            // acting
  double next_voltage_ = 0;       // computed, not yet acting
};

}  // namespace

StepRun RunStepTrial(const StepTrial& trial) {
  model::Actuator actuator(trial.model, {.arm_angle = trial.start});
  Loops loops(trial);
  const double full_torque = trial.model.parameters.T_pmax / trial.model.parameters.k_1;  // V
  const double full_voltage = std::min(trial.pressure.voltage_limit, full_torque) * (1 - 1e-9);
  StepRun run;
  const auto before = static_cast<int>(std::lround(trial.rest / trial.tick));
  const auto ticks = before + static_cast<int>(std::lround(trial.duration / trial.tick));
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
    if (k >= before && std::fabs(voltage) >= full_voltage) run.saturated += trial.tick;
    actuator.Advance(voltage, (k + 1) * trial.tick);
  }
  return run;
}

StepTrial TrialOf(const settings::StackConfig& config) {
  StepTrial trial;
  trial.model = config.model.description;
  trial.pressure = design::PressureLawSettingsFor(config);
  trial.position = design::PositionLawSettingsFor(config);
  trial.curve = design::BrakingCurveFor(config);
  trial.tick = 1 / config.plant.rate_hz;
  trial.interval = static_cast<int>(config.position_interval_ticks);
  trial.pressure_interval = static_cast<int>(config.pressure_interval_ticks);
  trial.command_delay = config.plant.command_delay_ticks;
  trial.dac_bits = config.position.dac_bits;
  trial.dac_range = config.position.dac_range_psi;
  return trial;
}

}  // namespace hydro::tune
