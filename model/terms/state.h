// The layout of the state vector.
#pragma once

namespace hydro::model {

// The state vector: theta, theta', p1, p2; with a free shaft alpha, alpha'; then the states of the effects.
inline constexpr int kMotorAngle = 0;
inline constexpr int kMotorSpeed = 1;
inline constexpr int kP1 = 2;
inline constexpr int kP2 = 3;
inline constexpr int kArmAngle = 4;  // free shaft only
inline constexpr int kArmSpeed = 5;  // free shaft only
inline constexpr int kMaxStates = 32;

}  // namespace hydro::model
