// What stands between two instants: the layout of the state vector, and the positions of the switches.
#pragma once

#include <array>
#include <cstddef>
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

// Where a simulation that does not begin at rest begins: the base states, indexed as above, followed by what
// no sensor shows. The arm's states are used with a free shaft only; with the bypass open, p2 is p1.
// Pressures below p_3 start at p_3. The states of effects start from these.
using StartState = std::array<double, 12>;
// rad: how much more than the angle sensor an effect that repeats with the shaft sees (motor.cogging,
// pump.flow_ripple).
inline constexpr size_t kTurn = 6;
// psi, four numbers: the waves under way in the lines of line.wave. For each side: the pump's pressure less
// the actuator's, and the line's flow times its impedance I w.
inline constexpr size_t kWaves = 7, kWaveNumbers = 4;
// in^3: the volume that the accumulator of accumulator.stiffness has already taken in, so that its pressure
// begins above p_3.
inline constexpr size_t kReturned = 11;

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
