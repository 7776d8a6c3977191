// Simulates what the machine does after a re-arm: the model of the configuration, from the state that was
// heard, with both loops as they run. It names the limit that stops the machine again, and the one that holds
// it back. Pure.
#pragma once

#include <functional>
#include <hydro/state_t.hpp>
#include <limits>
#include <string>

#include "settings/stack_config.h"

namespace hydro::tuning {

struct RearmMotion {
  std::string unforeseen = "nothing was simulated";  // why nothing is known; empty: the rest holds
  double seconds = 0;                                // after the re-arm, of what was simulated
  // The limit that zeroes the voltage again: "limits.motor_speed 20 rad/s"; empty: none.
  std::string ended_by = {};
  std::string held_by = {};  // the limit that holds the machine back at the end; empty: none
  double reaches = 0;        // the quantity that the reference refers to, at the end
  double arm_angle = std::numeric_limits<double>::quiet_NaN();  // at the end; NaN: the arm is not free
};

// "limits.pressure 3000 psi"
std::string LimitText(const settings::StackConfig& config, const std::string& key, double value);
// "limits.arm_torque 500 in-lbf"
std::string ArmTorqueLimit(const settings::StackConfig& config);

// `wanted` is the reference over plant time, as it would be without a hold. Ticks that the plant skips while
// it is re-armed, as many as before the last state, let the arm move on at zero volts.
RearmMotion SimulateRearm(const settings::StackConfig& config, const state_t& state,
                          const std::function<double(double)>& wanted, double seconds);

}  // namespace hydro::tuning
