// The configuration of a stack that runs the pressure loop with the arm clamped.
#pragma once

#include <string>

#include "pressure_ctrl/law/pressure_law.h"

namespace hydro::experiments {

struct ClampedLoop {
  double arm_angle = 0;         // rad
  double initial_pressure = 0;  // psi
  double duration = 0;          // s
  double rate_hz = 0;
  int delay_ticks = 0;  // 0: the command of tick k acts from tick k on
  pressure_ctrl::PressureGains gains = {};
  std::string reference;  // the keys of [reference] after its signal
};

// The reference is sampled at every tick; no pressure trips a fault. The model is model.toml.
std::string ClampedLoopConfig(const ClampedLoop& loop);

}  // namespace hydro::experiments
