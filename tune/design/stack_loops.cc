#include "tune/design/stack_loops.h"

#include <algorithm>

#include "tune/design/configured_laws.h"

namespace hydro::design {

using settings::ReferenceSignal;

LoopSettings LoopSettingsFor(const settings::StackConfig& config) {
  LoopSettings loops;
  loops.pressure = PressureLawSettingsFor(config);
  loops.position = PositionLawSettingsFor(config);
  loops.curve = BrakingCurveFor(config);
  loops.interval = static_cast<int>(config.position_interval_ticks);
  loops.pressure_interval = static_cast<int>(config.pressure_interval_ticks);
  loops.command_delay = config.plant.command_delay_ticks;
  loops.dac_bits = config.position.dac_bits;
  loops.dac_range = config.position.dac_range_psi;
  loops.signal = config.reference.signal;
  loops.torque_per_pressure = config.model.description.parameters.k_2;
  return loops;
}

StackLoops::StackLoops(const LoopSettings& settings, double angle, double speed)
    : settings_(settings), position_(settings.position) {
  const double before = angle - speed * settings.position.sample_interval;
  position_.Update(before, before, 1);
}

void StackLoops::SamplePosition(const model::Measurement& m, double reference) {
  double asked = 0;
  switch (settings_.signal) {
    case ReferenceSignal::kArmAngle:
      if (settings_.curve) reference = settings_.curve->Reference(m.arm_angle, reference);
      asked = position_.UpdateUnlimited(m.arm_angle, reference, 1);
      break;
    case ReferenceSignal::kPressure:
      asked = reference;
      break;
    case ReferenceSignal::kTorque:
      asked = reference / settings_.torque_per_pressure;
      break;
    case ReferenceSignal::kVoltage:
      open_loop_ = std::clamp(reference, -settings_.pressure.voltage_limit, settings_.pressure.voltage_limit);
      break;
  }
  const double limited = position_.Limited(asked);
  held_back_ = limited != asked;
  next_pressure_ref_ = position_ctrl::QuantiseDac(limited, settings_.dac_bits, settings_.dac_range);
}

double StackLoops::Voltage(int64_t k, const model::Measurement& m, double reference) {
  const bool open_loop = settings_.signal == ReferenceSignal::kVoltage;
  const double open_loop_before = open_loop_;
  if (settings_.command_delay > 0) {
    voltage_ = next_voltage_;
    input_.pressure_ref = next_pressure_ref_;
  }
  if (k % settings_.interval == 0) SamplePosition(m, reference);
  if (settings_.command_delay == 0) input_.pressure_ref = next_pressure_ref_;
  if (k % settings_.pressure_interval == 0) {
    input_.p1 = m.p1;
    input_.p2 = m.p2;
    input_.motor_speed = m.motor_speed;
    input_.arm_speed = m.arm_speed;
    next_voltage_ = !open_loop                    ? PressureLaw(settings_.pressure, input_).voltage
                    : settings_.command_delay > 0 ? open_loop_before
                                                  : open_loop_;
  }
  if (settings_.command_delay == 0) voltage_ = next_voltage_;
  return voltage_;
}

}  // namespace hydro::design
