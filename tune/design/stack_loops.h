// Both control loops of a stack, from a reading of its sensors to the next voltage, as the stack computes it
// in lockstep but without messages: for searches that need thousands of runs, and for forecasts.
#pragma once

#include <cstdint>
#include <optional>

#include "model/terms/measurement.h"
#include "position_ctrl/law/position_law.h"
#include "pressure_ctrl/law/pressure_law.h"
#include "settings/stack_config.h"

namespace hydro::design {

struct LoopSettings {
  pressure_ctrl::PressureLawSettings pressure;
  position_ctrl::PositionLawSettings position;
  std::optional<position_ctrl::BrakingCurve> curve = {};
  int interval = 1;           // ticks between samples of the position loop
  int pressure_interval = 1;  // ticks between samples of the pressure loop
  int command_delay = 1;      // ticks, as plant.command_delay_ticks
  int dac_bits = 0;           // as position.dac_bits
  double dac_range = 0;       // psi
  settings::ReferenceSignal signal = settings::ReferenceSignal::kArmAngle;
  double torque_per_pressure = 1;  // in-lbf/psi, k_2
};

// Those of a configuration. Throws InputError when gains cannot be derived.
LoopSettings LoopSettingsFor(const settings::StackConfig& config);

class StackLoops {
 public:
  // The arm has been at `angle`, moving at `speed`, for a sample, and its reference has followed it.
  // `settings` must outlive this.
  StackLoops(const LoopSettings& settings, double angle, double speed = 0);

  // The voltage that acts from tick k on. `reference` is looked at on the ticks that the position loop
  // samples.
  double Voltage(int64_t k, const model::Measurement& m, double reference);

  // Whether the position law asked for more pressure than limits.arm_torque allows.
  bool held_back() const { return held_back_; }
  // The pressure reference in force, psi; 0 in open loop.
  double pressure_ref() const { return input_.pressure_ref; }

 private:
  void SamplePosition(const model::Measurement& m, double reference);

  const LoopSettings& settings_;
  position_ctrl::PositionLaw position_;
  pressure_ctrl::PressureLawInput input_;
  double next_pressure_ref_ = 0;  // computed, not yet in force
  double voltage_ = 0;            // acting
  double next_voltage_ = 0;       // computed, not yet acting
  double open_loop_ = 0;          // V, of a reference that is a voltage
  bool held_back_ = false;
};

}  // namespace hydro::design
