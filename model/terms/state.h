// What stands between two instants: the layout of the state vector, and the positions of the switches.
#pragma once

#include <array>
#include <cstdint>

#include "model/terms/measurement.h"  // first: its Channel has enumerators of the same names

namespace hydro::model {

// The state vector: theta, theta', p1, p2; with a free shaft alpha, alpha'; then the states of the effects.
inline constexpr int kMotorAngle = 0;
inline constexpr int kMotorSpeed = 1;
inline constexpr int kP1 = 2;
inline constexpr int kP2 = 3;
inline constexpr int kArmAngle = 4;  // free shaft only
inline constexpr int kArmSpeed = 5;  // free shaft only
inline constexpr int kMaxStates = 32;

// The positions of the model's switches. Between two changes of mode the right-hand side is smooth.

// The largest number of switches that effects can add to one model.
inline constexpr int kMaxEffectSwitches = 13;
inline constexpr int kMaxSwitches = 3 + kMaxEffectSwitches;

// Numbers of the base switches, in the margins of Equations::Rates and as `which` of Equations::Cross. The
// effects' switches follow.
inline constexpr int kPumpSwitch = 0;
inline constexpr int kValve1Switch = 1;
inline constexpr int kValve2Switch = 2;
inline constexpr int kFirstEffectSwitch = 3;

struct Mode {
  // The pump: 0 sticks; +1 or -1 slips in that direction, with friction opposing the motion.
  int8_t pump = 0;
  // The one-way valves from the accumulator: 1 open (the pressure is held at p_3), 0 closed. With the bypass
  // open, valve_1 stands for both.
  int8_t valve_1 = 0;
  int8_t valve_2 = 0;
  // The effects' switches. Each effect documents the meaning of its positions.
  std::array<int8_t, kMaxEffectSwitches> effects{};

  bool operator==(const Mode&) const = default;
};

}  // namespace hydro::model
