#include "experiments/runs/step_trial.h"

#include <cmath>

#include "model/actuator.h"

namespace hydro::experiments {

design::Response RunStepTrial(const StepTrial& trial) {
  model::Actuator actuator(trial.model, {});
  position_ctrl::PositionLaw position(trial.position);
  // The law's history before the step: the arm at rest at 0.
  position.Update(0, 0, 1);
  pressure_ctrl::PressureLawInput input;
  double next_pressure_ref = 0;  // computed, not yet in force
  double voltage = 0;            // acting
  double next_voltage = 0;       // computed, not yet acting
  design::Response response;
  const auto ticks = static_cast<int>(std::lround(trial.duration / trial.tick));
  for (int k = 0; k <= ticks; ++k) {
    const model::Measurement m = actuator.Measure();
    response.time.push_back(k * trial.tick);
    response.angle.push_back(m.arm_angle);
    if (trial.command_delay > 0) {
      voltage = next_voltage;
      input.pressure_ref = next_pressure_ref;
    }
    if (k % trial.interval == 0) next_pressure_ref = position.Update(m.arm_angle, trial.step, 1);
    if (trial.command_delay == 0) input.pressure_ref = next_pressure_ref;
    input.p1 = m.p1;
    input.p2 = m.p2;
    input.motor_speed = m.motor_speed;
    input.arm_speed = m.arm_speed;
    next_voltage = pressure_ctrl::PressureLaw(trial.pressure, input).voltage;
    if (trial.command_delay == 0) voltage = next_voltage;
    actuator.Advance(voltage, (k + 1) * trial.tick);
  }
  return response;
}

}  // namespace hydro::experiments
